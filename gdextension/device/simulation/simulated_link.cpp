#include "device/simulation/simulated_link.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spidar {

namespace {

// Rates of the faults: one report in this many.
constexpr std::uint32_t kLostEvery = 100;
constexpr std::uint32_t kRepeatedEvery = 100;
constexpr std::uint32_t kSwappedEvery = 50;
// Longest jitter delay, in units of its mean.
constexpr double kLongestJitter = 20.0;

} // namespace

void SimulatedLink::configure(const PlantSettings &settings) noexcept {
    *this = SimulatedLink();
    latency_s_ = settings.output_latency_s;
    jitter_s_ = settings.output_jitter_s;
    loss_ = settings.report_loss;
}

double SimulatedLink::random() noexcept {
    state_ += 0x9E3779B97F4A7C15U; // splitmix64
    std::uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    x ^= x >> 31;
    return static_cast<double>(x >> 11) * 0x1p-53;
}

void SimulatedLink::send(const StringArray &currents_a, double now_s, double extra_s) noexcept {
    double delay_s = latency_s_ + extra_s;
    if (jitter_s_ > 0.0) {
        delay_s += jitter_s_ * std::min(kLongestJitter, -std::log(1.0 - random()));
    }
    if (count_ == kMostOnTheWay) { // the oldest is dropped
        first_ = (first_ + 1) % kMostOnTheWay;
        --count_;
    }
    // On one wire no command overtakes another.
    const double due_s = count_ > 0 ? std::max(last_due_s_, now_s + delay_s) : now_s + delay_s;
    ring_[(first_ + count_) % kMostOnTheWay] = {due_s, currents_a};
    last_due_s_ = due_s;
    ++count_;
}

double SimulatedLink::next_s() const noexcept {
    return count_ > 0 ? ring_[first_].due_s : std::numeric_limits<double>::infinity();
}

StringArray SimulatedLink::receive() noexcept {
    if (count_ == 0) {
        return {};
    }
    const StringArray currents_a = ring_[first_].currents_a;
    first_ = (first_ + 1) % kMostOnTheWay;
    --count_;
    return currents_a;
}

bool SimulatedLink::deliver(DeviceReading &report, const ActiveFaults &faults) noexcept {
    ++made_;
    if (held_for_ > 0) {
        --held_for_;
        if (held_for_ == 0) { // delivers the overtaken report instead of this one
            report = held_;
            return true;
        }
    }
    if (loss_ > 0.0 && random() < loss_) {
        return false;
    }
    if (faults.has(SimulatedFault::reports_lost) && made_ % kLostEvery == 0) {
        return false;
    }
    if (faults.has(SimulatedFault::reports_repeated) && made_ % kRepeatedEvery == 0) {
        report = before_;
        return true;
    }
    if (faults.has(SimulatedFault::reports_swapped) && made_ % kSwappedEvery == 0) {
        held_ = report;
        held_for_ = 2;
        return false;
    }
    before_ = report;
    return true;
}

} // namespace spidar
