#include "device/simulation/fault_injection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Sums of times such as 0.1 s + 0.05 s err by rounding: half a microsecond belongs to the later
// side.
constexpr double kTimeTolerance_s = 5e-7;

} // namespace

bool is_usable(const FaultInjection &fault) noexcept {
    return static_cast<int>(fault.fault) < kSimulatedFaultCount && fault.string >= 0 &&
           fault.string < kStringCount && fault.start_s >= 0.0 &&
           all_finite(fault.start_s, fault.duration_s);
}

void FaultSchedule::set(const FaultList &faults, double now_s) noexcept {
    for (std::size_t i = 0; i < faults.size(); ++i) {
        if (faults[i].number != faults_[i].number) {
            begin_s_[i] = now_s + faults[i].injection.start_s;
        }
    }
    faults_ = faults;
}

double FaultSchedule::end_s(std::size_t place) const noexcept {
    const double duration_s = faults_[place].injection.duration_s;
    return duration_s > 0.0 ? begin_s_[place] + duration_s
                            : std::numeric_limits<double>::infinity();
}

ActiveFaults FaultSchedule::at(double now_s) const noexcept {
    ActiveFaults active;
    const double now = now_s + kTimeTolerance_s;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
        if (faults_[i].number == 0 || now < begin_s_[i] || now >= end_s(i)) {
            continue;
        }
        const FaultInjection &injection = faults_[i].injection;
        const auto string = static_cast<std::size_t>(injection.string);
        active.strings[static_cast<std::size_t>(injection.fault)] |=
            static_cast<std::uint8_t>(1U << string);
        if (injection.fault == SimulatedFault::slipped_string) {
            active.slip_m[string] = std::min(kSlip_m, kSlipSpeed_m_s * (now - begin_s_[i]));
        }
    }
    return active;
}

std::array<std::uint32_t, kMaxFaults> FaultSchedule::finished(double now_s) const noexcept {
    std::array<std::uint32_t, kMaxFaults> numbers{};
    for (std::size_t i = 0; i < faults_.size(); ++i) {
        if (now_s + kTimeTolerance_s >= end_s(i)) {
            numbers[i] = faults_[i].number;
        }
    }
    return numbers;
}

} // namespace spidar
