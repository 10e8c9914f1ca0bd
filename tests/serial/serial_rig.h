// What the tests of the serial transport share: buses, a place for their links, and a loop that is brought to pull.
#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include <unistd.h>

#include "board_model/known_buses.h"
#include "device/loop/servo_loop.h"
#include "device/serial/port_guard.h"
#include "device/serial/serial_transport.h"
#include "device/threads/real_time_thread.h"
#include "support/servo_fixture.h"

namespace spidar::test {

inline const std::string kGuardProgram = std::string("addons/spidar_g/bin/") + kGuardFile;

inline void sleep_ms(int time_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(time_ms));
}

// Polls each 0.2 ms until it holds; false after the limit.
template <typename Condition>
bool wait_for(const Condition &condition, int limit_ms) {
    const std::int64_t end_ns = monotonic_ns() + limit_ms * 1'000'000LL;
    while (!condition()) {
        if (monotonic_ns() > end_ns) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return true;
}

inline std::string link_of_this_test() {
    static int number = 0;
    return "/tmp/spidar_serial_" + std::to_string(getpid()) + "_" + std::to_string(++number);
}

inline SerialTransportSettings settings_for(const std::string &link) {
    SerialTransportSettings settings;
    settings.port = link;
    settings.guard = kGuardProgram;
    return settings;
}

// The game's side: commands each few milliseconds, until the loop is in a state.
class SerialHost {
public:
    explicit SerialHost(const SerialTransportSettings &settings) {
        auto made = std::make_unique<SerialTransport>(settings);
        transport = made.get();
        loop = std::make_unique<ServoLoop>(std::move(made));
        servo = ideal_settings();
        servo.safety.arming_time_s = 0.05;
        command.forces_enabled = true;
    }
    Status start() { return loop->start_threaded(servo); }

    // One word of the game, a millisecond long.
    const ServoSnapshot &tick() {
        ++command.heartbeat;
        ++command.wrench_sequence;
        command.wrench_duration_s = 0.5;
        loop->publish(command);
        std::this_thread::sleep_for(std::chrono::microseconds(900));
        (void)loop->latest(now);
        return now;
    }
    bool run_until(DeviceState state, int limit_ms) {
        for (int i = 0; i < limit_ms && now.state != state; ++i) {
            tick();
        }
        return now.state == state;
    }
    // clear_fault() until it is.
    bool recover() {
        for (int i = 0; i < 40 && now.state != DeviceState::connected; ++i) {
            ++command.clear_fault_count;
            (void)run_until(DeviceState::connected, 50);
        }
        return now.state == DeviceState::connected;
    }
    // zero_at_home() and arm(), while somebody moves the hand by wave(): then the motors pull. A busy machine may hold the
    // loop up for so long that it is in FAULT: then it is tried again.
    template <typename Move>
    bool activate(const Move &move, int tries = 10) {
        for (int i = 0; i < tries && !pulls_after(move); ++i) {
            if (i + 1 < tries) {
                move(0.0);
                sleep_ms(500);
                (void)recover();
            }
        }
        return now.state == DeviceState::active;
    }

    SerialTransport *transport = nullptr;
    std::unique_ptr<ServoLoop> loop;
    ServoSettings servo;
    HapticCommand command;
    ServoSnapshot now;

private:
    template <typename Move>
    bool pulls_after(const Move &move) {
        if (!run_until(DeviceState::connected, 1000)) {
            return false;
        }
        ++command.zero_count;
        const std::int64_t start_ns = monotonic_ns();
        bool armed = false;
        for (int i = 0; i < 5'000 && now.state != DeviceState::active &&
                        now.state != DeviceState::fault && now.state != DeviceState::closed;
             ++i) {
            tick();
            move(1e-9 * static_cast<double>(monotonic_ns() - start_ns));
            if (!armed && now.state == DeviceState::calibrated && now.zero_known) {
                ++command.arm_count;
                armed = true;
            }
        }
        return now.state == DeviceState::active;
    }
};

} // namespace spidar::test
