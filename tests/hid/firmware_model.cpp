#include "hid/firmware_model.h"

#include <algorithm>

namespace spidar::test {

namespace {

constexpr std::uint32_t kMicrosecondsPerMillisecond = 1000;
constexpr std::uint16_t kSupply_mv = 24000;
constexpr std::uint8_t kLatchedFaults = state_flag::kEmergencyStop | state_flag::kWatchdogTripped |
                                        state_flag::kEncoderFault | state_flag::kOverTemperature;

std::int32_t wrapping_sum(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

std::int32_t wrapping_difference(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

} // namespace

FirmwareModel::FirmwareModel(const FirmwareSettings &settings)
    : settings_(settings), limits_(settings.limits) {}

bool FirmwareModel::healthy() const noexcept {
    return latched_ == 0 && inputs.motor_power && !paused_;
}

void FirmwareModel::switch_off() noexcept {
    mode_ = Mode::disabled;
    motors_mn_ = {};
    ramp_us_ = 0;
}

void FirmwareModel::latch_faults() noexcept {
    latched_ |= inputs.emergency_stop ? state_flag::kEmergencyStop : std::uint8_t{0};
    latched_ |= inputs.too_hot ? state_flag::kOverTemperature : std::uint8_t{0};
    if (inputs.faulty_encoders != 0) {
        latched_ |= state_flag::kEncoderFault;
        fault_strings_ |= inputs.faulty_encoders;
    }
}

void FirmwareModel::receive(ReportBytes bytes) noexcept {
    CommandReport command;
    if (decode(bytes, command) != Decoded::ok) {
        ++counters_.rejected;
        return;
    }
    if (accepted_ != kNoSequence) {
        if (!is_newer(command.sequence, accepted_)) {
            ++counters_.stale;
            return;
        }
        counters_.lost += sequence_steps(accepted_, command.sequence) - 1;
    }
    ++counters_.accepted;
    accepted_ = command.sequence;
    command_ = command;
    since_command_us_ = 0;
    if ((command.flags & command_flag::kEmergencyStop) != 0) {
        latched_ |= state_flag::kEmergencyStop;
    }
    const bool enable = (command.flags & command_flag::kEnable) != 0;
    if (!enable) {
        switch_off();
        if ((command.flags & command_flag::kClearFaults) != 0) {
            latched_ = 0;
            fault_strings_ = 0;
            latch_faults(); // what still is wrong stays latched
        }
        return;
    }
    if (!healthy()) {
        switch_off();
        return;
    }
    mode_ = Mode::active;
}

bool FirmwareModel::set_feature(ReportBytes bytes) noexcept {
    HidLimits limits;
    if (decode(bytes, limits) == Decoded::ok) {
        const HidCapabilities &own = settings_.capabilities;
        const HidLimits &fixed = settings_.limits;
        limits_.max_tension_mn =
            std::min({limits.max_tension_mn, fixed.max_tension_mn, own.max_tension_mn});
        limits_.tension_rate_mn_ms = std::min(
            {limits.tension_rate_mn_ms, fixed.tension_rate_mn_ms, own.max_tension_rate_mn_ms});
        limits_.string_speed_mm_s = std::min(limits.string_speed_mm_s, fixed.string_speed_mm_s);
        limits_.ramp_in_ms = std::max(limits.ramp_in_ms, fixed.ramp_in_ms);
        limits_.min_tension_mn = std::min({limits.min_tension_mn, limits_.max_tension_mn});
        return true;
    }
    HidZero zero;
    if (decode(bytes, zero) == Decoded::ok) {
        if (mode_ != Mode::disabled) {
            return false;
        }
        for (std::size_t i = 0; i < zero.counts.size(); ++i) {
            zero_offset_[i] = wrapping_difference(zero.counts[i], inputs.raw_counts[i]);
        }
        zeroed_ = true;
        return true;
    }
    DeviceControl control{};
    if (decode(bytes, control) != Decoded::ok) {
        return false;
    }
    switch (control) {
    case DeviceControl::enable: // commands enable, one by one; this alone moves nothing
        break;
    case DeviceControl::disable:
    case DeviceControl::stop_all:
        switch_off();
        break;
    case DeviceControl::reset:
        bus_reset();
        break;
    case DeviceControl::pause:
        paused_ = true;
        switch_off();
        break;
    case DeviceControl::proceed:
        paused_ = false;
        break;
    }
    return true;
}

std::size_t
FirmwareModel::get_feature(std::uint8_t id,
                           std::array<std::uint8_t, kLargestReport> &bytes) const noexcept {
    if (id == static_cast<std::uint8_t>(HidReportId::capabilities)) {
        const auto report = encode(settings_.capabilities);
        std::copy(report.begin(), report.end(), bytes.begin());
        return report.size();
    }
    if (id == static_cast<std::uint8_t>(HidReportId::limits)) {
        const auto report = encode(limits_);
        std::copy(report.begin(), report.end(), bytes.begin());
        return report.size();
    }
    return 0;
}

void FirmwareModel::bus_reset() noexcept {
    switch_off();
    limits_ = settings_.limits;
    accepted_ = kNoSequence;
    zeroed_ = false;
    zero_offset_ = {};
    latched_ = 0;
    fault_strings_ = 0;
    clipped_ = false;
    paused_ = false;
    sequence_ = 0;
    command_ = {};
}

void FirmwareModel::advance(std::uint32_t dt_us) noexcept {
    time_us_ += dt_us;
    sequence_ = next_sequence(sequence_);
    latch_faults();
    if (mode_ == Mode::disabled) {
        return;
    }
    since_command_us_ += dt_us;
    if (!healthy()) {
        switch_off();
        return;
    }
    if (since_command_us_ >= settings_.motors_off_after_us) {
        ++counters_.trips;
        latched_ |= state_flag::kWatchdogTripped;
        switch_off();
        return;
    }
    const std::uint32_t valid_ms =
        std::min<std::uint32_t>(command_.valid_for_ms, settings_.capabilities.watchdog_limit_ms);
    if (mode_ == Mode::active && since_command_us_ >= valid_ms * kMicrosecondsPerMillisecond) {
        ++counters_.holds;
        mode_ = Mode::holding;
    }
    const std::uint32_t ramp_full_us = limits_.ramp_in_ms * kMicrosecondsPerMillisecond;
    ramp_us_ = std::min(ramp_us_ + dt_us, ramp_full_us);
    const bool hold = mode_ == Mode::holding || (command_.flags & command_flag::kHold) != 0;
    const std::uint32_t step_mn = std::max<std::uint32_t>(1, limits_.tension_rate_mn_ms * dt_us /
                                                                 kMicrosecondsPerMillisecond);
    clipped_ = false;
    for (std::size_t i = 0; i < motors_mn_.size(); ++i) {
        const std::uint32_t asked = hold ? limits_.min_tension_mn : command_.tensions_mn[i];
        std::uint32_t wanted = std::min<std::uint32_t>(asked, limits_.max_tension_mn);
        clipped_ = clipped_ || wanted != asked;
        if (ramp_us_ < ramp_full_us) {
            // 64 bits: tension times microseconds.
            wanted = static_cast<std::uint32_t>(std::uint64_t{wanted} * ramp_us_ / ramp_full_us);
        }
        const std::uint32_t now = motors_mn_[i];
        // Rises at the limit's rate; falls at once, which pulls nobody.
        motors_mn_[i] = static_cast<std::uint16_t>(std::min(wanted, now + step_mn));
    }
}

std::uint8_t FirmwareModel::flags() const noexcept {
    std::uint8_t flags = latched_ & kLatchedFaults;
    flags |= mode_ != Mode::disabled ? state_flag::kActuatorsEnabled : std::uint8_t{0};
    flags |= inputs.motor_power ? state_flag::kActuatorPower : std::uint8_t{0};
    flags |= clipped_ ? state_flag::kCommandClipped : std::uint8_t{0};
    flags |= zeroed_ ? state_flag::kZeroed : std::uint8_t{0};
    return flags;
}

std::array<std::uint8_t, kStateSize> FirmwareModel::report() const noexcept {
    StateReport state;
    state.flags = flags();
    state.sequence = sequence_;
    state.accepted_command = accepted_;
    state.device_time_us = time_us_;
    for (std::size_t i = 0; i < state.counts.size(); ++i) {
        state.counts[i] = wrapping_sum(inputs.raw_counts[i], zero_offset_[i]);
    }
    state.tensions_mn.fill(kNotMeasured);
    state.buttons = inputs.buttons;
    state.fault_strings = fault_strings_;
    state.supply_mv = inputs.motor_power ? kSupply_mv : std::uint16_t{0};
    return encode(state);
}

} // namespace spidar::test
