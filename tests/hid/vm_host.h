// The host's side in the VM test: the real HidTransport and ServoLoop, as the add-on uses them.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/hid/hid_transport.h"
#include "device/loop/servo_loop.h"

namespace spidar::test {

struct VmHost {
    explicit VmHost(const std::string &serial, std::shared_ptr<HidBus> bus = system_hid_bus());

    Status start();
    // Zeroes at home, arms, and pulls with `force_n` along Y until the state is active. False: it did not get there.
    bool activate(double force_n);
    // Renews the request every 10 ms for this long.
    void pull(double seconds);
    // Waits at most `seconds` for the condition of the newest snapshot; looks every 0.2 ms. The time it was seen, in
    // ns of the monotonic clock; -1: not within the time.
    std::int64_t wait_for(const std::function<bool(const ServoSnapshot &)> &condition,
                          double seconds);
    const ServoSnapshot &look();

    ServoSettings settings;
    HidTransport *transport; // owned by loop
    ServoLoop loop;
    HapticCommand command;
    ServoSnapshot snapshot;
    double force_n = 0.0;

private:
    VmHost(const std::string &serial, std::unique_ptr<HidTransport> owned);
    void ask();
};

void sleep_ms(double milliseconds);

} // namespace spidar::test
