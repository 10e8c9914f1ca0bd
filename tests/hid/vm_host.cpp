#include "hid/vm_host.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "hid/virtual_device.h"

namespace spidar::test {

namespace {

constexpr double kRenew_ms = 10.0;
constexpr double kLook_ms = 0.2;

HidTransportSettings settings_for(const std::string &serial) {
    HidTransportSettings settings;
    settings.filter.serial = serial;
    return settings;
}

} // namespace

void sleep_ms(double milliseconds) {
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(milliseconds));
}

VmHost::VmHost(const std::string &serial, std::shared_ptr<HidBus> bus)
    : VmHost(serial, std::make_unique<HidTransport>(std::move(bus), settings_for(serial))) {}

VmHost::VmHost(const std::string &, std::unique_ptr<HidTransport> owned)
    : transport(owned.get()), loop(std::move(owned)) {
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          CountArray{}, kPaperMetresPerCount);
    settings.safety.arming_time_s = 0.1;
}

Status VmHost::start() {
    return loop.start_threaded(settings);
}

const ServoSnapshot &VmHost::look() {
    loop.latest(snapshot);
    return snapshot;
}

void VmHost::ask() {
    ++command.wrench_sequence;
    command.wrench = Wrench();
    command.wrench.force_n.y = force_n;
    command.wrench_duration_s = 0.05;
    loop.publish(command);
}

bool VmHost::activate(double force_in_n) {
    if (!usable(transport->zero(CountArray{}))) {
        return false;
    }
    sleep_ms(150.0); // until reports of before the zero have left every queue
    force_n = 0.0;
    command.forces_enabled = true;
    ++command.clear_fault_count;
    ask();
    sleep_ms(20.0);
    ++command.arm_count;
    for (int i = 0; i < 100 && look().state != DeviceState::active; ++i) {
        ask();
        sleep_ms(kRenew_ms);
    }
    force_n = force_in_n;
    pull(0.15);
    return look().state == DeviceState::active;
}

void VmHost::pull(double seconds) {
    const std::int64_t end_ns = now_ns() + static_cast<std::int64_t>(std::llround(seconds * 1e9));
    while (now_ns() < end_ns) {
        ask();
        sleep_ms(kRenew_ms);
    }
}

std::int64_t VmHost::wait_for(const std::function<bool(const ServoSnapshot &)> &condition,
                              double seconds) {
    const std::int64_t end_ns = now_ns() + static_cast<std::int64_t>(std::llround(seconds * 1e9));
    std::int64_t renewed_ns = 0;
    while (now_ns() < end_ns) {
        if (condition(look())) {
            return now_ns();
        }
        if (now_ns() - renewed_ns > static_cast<std::int64_t>(kRenew_ms * 1e6)) {
            renewed_ns = now_ns();
            ask();
        }
        sleep_ms(kLook_ms);
    }
    return -1;
}

} // namespace spidar::test
