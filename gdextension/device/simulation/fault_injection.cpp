#include "device/simulation/fault_injection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/types.h"

namespace spidar {

namespace {

// Sums of times like 0.1 s + 0.05 s miss by rounding: half a microsecond belongs to the later side.
constexpr double kTimeTolerance_s = 5e-7;

} // namespace

bool is_usable(const FaultInjection &fault) noexcept {
    return fault.fault <= SimulatedFault::blocked_output && fault.string >= 0 &&
           fault.string < kStringCount && std::isfinite(fault.start_s) && fault.start_s >= 0.0 &&
           std::isfinite(fault.duration_s);
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
        const auto bit = static_cast<std::uint8_t>(1U << faults_[i].injection.string);
        switch (faults_[i].injection.fault) {
        case SimulatedFault::output_cut:
            active.output_cut = true;
            break;
        case SimulatedFault::frozen_counts:
            active.frozen_counts = true;
            break;
        case SimulatedFault::count_jump:
            active.jumped_mask |= bit;
            break;
        case SimulatedFault::read_timeout:
            active.read_timeout = true;
            break;
        case SimulatedFault::unplugged:
            active.unplugged = true;
            break;
        case SimulatedFault::stuck_encoder:
            active.stuck_mask |= bit;
            break;
        case SimulatedFault::broken_string:
            active.broken_mask |= bit;
            break;
        case SimulatedFault::hand_released:
            active.hand_released = true;
            break;
        case SimulatedFault::jammed_drum:
            active.jammed_mask |= bit;
            break;
        case SimulatedFault::slipped_string:
            active.slip_m[static_cast<std::size_t>(faults_[i].injection.string)] =
                std::min(kSlip_m, kSlipSpeed_m_s * (now - begin_s_[i]));
            break;
        case SimulatedFault::counts_reset:
            active.counts_reset = true;
            break;
        case SimulatedFault::reversed_encoder:
            active.reversed_mask |= bit;
            break;
        case SimulatedFault::swapped_encoders:
            active.swapped_mask |= bit;
            break;
        case SimulatedFault::reports_lost:
            active.reports_lost = true;
            break;
        case SimulatedFault::reports_repeated:
            active.reports_repeated = true;
            break;
        case SimulatedFault::reports_swapped:
            active.reports_swapped = true;
            break;
        case SimulatedFault::late_output:
            active.late_output = true;
            break;
        case SimulatedFault::blocked_output:
            active.blocked_output = true;
            break;
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
