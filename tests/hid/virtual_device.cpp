#include "hid/virtual_device.h"

#include <algorithm>
#include <cmath>

#include <sys/timerfd.h>
#include <time.h>

#include "core/calibration/string_calibration.h"

namespace spidar::test {

namespace {

constexpr std::uint32_t kTick_us = 1000;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::size_t kShortReport = 40;
constexpr double kMotion_m = 0.005;
constexpr double kMotion_rad_ms = 2.0 * 3.14159265358979 / 1000.0; // once a second

bool take_one(std::atomic<int> &count) {
    if (count.load() <= 0) {
        return false;
    }
    count.fetch_sub(1);
    return true;
}

} // namespace

std::int64_t now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec;
}

int millisecond_timer() {
    const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
    itimerspec every{};
    every.it_interval.tv_nsec = kTick_us * 1000;
    every.it_value.tv_nsec = kTick_us * 1000;
    if (timer >= 0) {
        timerfd_settime(timer, 0, &every, nullptr);
    }
    return timer;
}

DeviceObservations VirtualDevice::observations() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return seen_;
}

void VirtualDevice::clear_observations() {
    const std::lock_guard<std::mutex> lock(mutex_);
    seen_ = {};
    seen_.motors.reserve(20'000);
}

void VirtualDevice::move_grip() {
    const bool zeroed = (firmware_.flags() & state_flag::kZeroed) != 0;
    moving_ms_ = zeroed ? moving_ms_ + 1 : 0;
    GripPose pose = rest_pose(grip_);
    const StringArray home_m = string_lengths(frame_, grip_, pose);
    pose.position_m.y += kMotion_m * std::sin(kMotion_rad_ms * moving_ms_);
    const StringArray lengths_m = string_lengths(frame_, grip_, pose);
    for (std::size_t i = 0; i < lengths_m.size(); ++i) {
        firmware_.inputs.raw_counts[i] = static_cast<std::int32_t>(
            std::lround((lengths_m[i] - home_m[i]) / kPaperMetresPerCount));
    }
}

std::vector<std::vector<std::uint8_t>> VirtualDevice::tick(std::uint64_t expirations) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::uint64_t i = 0; i < expirations; ++i) {
        move_grip();
        firmware_.advance(kTick_us);
    }
    ++seen_.ticks;
    seen_.overruns += expirations - 1;
    const auto &motors = firmware_.motors_mn();
    seen_.motors.push_back({now_ns(), *std::max_element(motors.begin(), motors.end()),
                            *std::min_element(motors.begin(), motors.end())});
    if (take_one(faults.silent)) {
        return {};
    }
    const ReportArray report = firmware_.report();
    std::vector<std::vector<std::uint8_t>> out;
    std::vector<std::uint8_t> bytes(report.begin(), report.end());
    if (take_one(faults.corrupted)) {
        bytes[20] ^= 0x10U;
    } else if (take_one(faults.shortened)) {
        bytes.resize(kShortReport);
    }
    out.push_back(bytes);
    if (take_one(faults.replayed)) {
        out.emplace_back(report.begin(), report.end());
    }
    if (take_one(faults.reordered)) {
        out.emplace_back(older_.begin(), older_.end());
    }
    older_ = last_;
    last_ = report;
    seen_.reports += out.size();
    seen_.last_report_ns = now_ns();
    return out;
}

void VirtualDevice::receive(ReportBytes bytes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++seen_.commands;
    CommandReport command;
    StateReport newest;
    if (decode(bytes, command) == Decoded::ok &&
        decode(firmware_.report(), newest) == Decoded::ok &&
        command.answers_state == newest.sequence) {
        ++seen_.commands_on_newest_state;
    }
    firmware_.receive(bytes);
}

} // namespace spidar::test
