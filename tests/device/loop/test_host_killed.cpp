// The host dies or stands still: a child process drives a firmware model over a socket pair with the real servo loop, and
// is killed (SIGKILL) or stopped (SIGSTOP, as a debugger's breakpoint does) in every state that holds tension. The firmware
// alone must bring the motors down.
#include <doctest/doctest.h>

#if defined(__linux__)

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <string>

#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/hid/protocol/hid_codec.h"
#include "device/hid/protocol/report_sequence.h"
#include "device/threads/real_time_thread.h"
#include "hid/firmware_model.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::FirmwareModel;
using spidar::test::ideal_settings;

namespace {

constexpr std::uint16_t kValid_ms = 20;

// Commands as HID reports into a socket; at home until it is moved.
class SocketTransport final : public Transport {
public:
    explicit SocketTransport(int socket) : socket_(socket) {}
    Status open() noexcept override { return Status::ok; }
    void close() noexcept override {}
    Status read(DeviceReading &reading) noexcept override {
        reading.counts = counts;
        return Status::ok;
    }
    CountArray counts{};
    Status write(const DriveCommand &command) noexcept override {
        CommandReport report;
        report.flags = command.motors_on ? command_flag::kEnable : std::uint8_t{0};
        sequence_ = next_sequence(sequence_);
        report.sequence = sequence_;
        report.valid_for_ms = kValid_ms;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            report.tensions_mn[i] =
                static_cast<std::uint16_t>(std::lround(1e3 * command.tensions_n[i]));
        }
        const auto bytes = encode(report);
        return send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
                       static_cast<ssize_t>(bytes.size())
                   ? Status::ok
                   : Status::write_failed;
    }
    [[nodiscard]] bool simulated() const noexcept override { return true; }

private:
    int socket_;
    std::uint16_t sequence_ = 0;
};

// Brings the device into this state, moving the grip where that is what it takes, and holds it there.
[[noreturn]] void play_host(int socket, DeviceState wanted) {
    ServoSettings settings = ideal_settings();
    settings.safety.arming_time_s = 0.01;
    auto made = std::make_unique<SocketTransport>(socket);
    SocketTransport &device = *made;
    ServoLoop loop(std::move(made));
    HapticCommand command;
    command.forces_enabled = true;
    command.wrench.force_n = Vec3(0.0, 3.0, 0.0);
    command.wrench_duration_s = 60.0;
    // In this very thread: a process that forked from one with threads is no place to start others.
    (void)loop.start_stepped(settings);
    const bool zeroes = wanted != DeviceState::active;
    command.zero_count = zeroes ? 1 : 0;
    ServoSnapshot now;
    for (int ms = 0;; ++ms) {
        ++command.heartbeat;
        ++command.wrench_sequence;
        loop.publish(command);
        loop.advance(1, 1000);
        (void)loop.latest(now);
        if (wanted == DeviceState::calibrated && now.state == DeviceState::taut && ms > 700) {
            const double way = 0.001 * (ms - 700);
            device.counts = spidar::test::counts_of(
                settings, spidar::test::moved_by(settings, 0.04 * Vec3(std::sin(4.0 * way),
                                                                       std::sin(3.0 * way),
                                                                       -std::sin(3.5 * way))));
        }
        const bool there = now.state == wanted && (wanted != DeviceState::taut || ms > 600);
        if (there) { // a packet of one byte tells the test so
            (void)send(socket, "!", 1, MSG_DONTWAIT | MSG_NOSIGNAL);
        }
        usleep(1000);
    }
}

std::uint16_t strongest(const FirmwareModel &firmware) {
    const auto &motors = firmware.motors_mn();
    return *std::max_element(motors.begin(), motors.end());
}

struct Released {
    bool stopped = false; // the signal was sent while the motors pulled
    std::uint16_t pulled_mn = 0;
    std::uint16_t most_after_mn = 0;
    std::uint32_t held_us = 0; // from the last command to minimum tension, and to none
    std::uint32_t off_us = 0;
};

Released stop_host(DeviceState state, int signal_number) {
    Released result;
    int sockets[2] = {-1, -1};
    REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, sockets) == 0);
    const pid_t host = fork();
    REQUIRE(host >= 0);
    if (host == 0) {
        close(sockets[0]);
        play_host(sockets[1], state);
    }
    close(sockets[1]);
    const spidar::test::FirmwareSettings settings;
    // Pretension is 500 mN, of which the firmware's own ramp may still hold some back.
    const std::uint16_t pulls_mn = state == DeviceState::active ? 1000 : 450;
    FirmwareModel firmware(settings);
    REQUIRE(firmware.set_feature(encode(HidZero{})));

    // The firmware's clock is the wall's; a packet is taken when it is there, as an endpoint does.
    std::int64_t last_ns = monotonic_ns();
    const std::int64_t start_ns = last_ns;
    std::uint32_t last_packet_us = 0;
    bool there = false;
    while (result.off_us == 0 && monotonic_ns() - start_ns < 30'000'000'000) {
        pollfd waiting{sockets[0], POLLIN, 0};
        (void)poll(&waiting, 1, 1);
        std::uint8_t bytes[kLargestReport];
        for (;;) {
            const ssize_t size = recv(sockets[0], bytes, sizeof bytes, MSG_DONTWAIT);
            if (size <= 0) {
                break;
            }
            if (size == 1) {
                there = true;
                continue;
            }
            firmware.receive({bytes, static_cast<std::size_t>(size)});
            last_packet_us = firmware.time_us();
        }
        const std::int64_t now_ns = monotonic_ns();
        // In steps of the firmware's tick, however long this process slept.
        for (auto left_us = static_cast<std::uint32_t>((now_ns - last_ns) / 1000); left_us > 0;) {
            const std::uint32_t step_us = std::min<std::uint32_t>(left_us, 500);
            firmware.advance(step_us);
            left_us -= step_us;
            if (!result.stopped) {
                continue;
            }
            result.most_after_mn = std::max(result.most_after_mn, strongest(firmware));
            if (result.held_us == 0 && strongest(firmware) <= settings.limits.min_tension_mn) {
                result.held_us = firmware.time_us() - last_packet_us;
            }
            if (result.off_us == 0 && strongest(firmware) == 0) {
                result.off_us = firmware.time_us() - last_packet_us;
            }
        }
        last_ns += (now_ns - last_ns) / 1000 * 1000;
        if (!result.stopped && (firmware.flags() & state_flag::kWatchdogTripped) != 0) {
            firmware = FirmwareModel(settings); // a busy machine starved the host: power it again
            REQUIRE(firmware.set_feature(encode(HidZero{})));
            there = false;
        }
        if (!result.stopped && there && strongest(firmware) >= pulls_mn) {
            result.pulled_mn = strongest(firmware);
            REQUIRE(kill(host, signal_number) == 0);
            int status = 0;
            REQUIRE(waitpid(host, &status, WUNTRACED) == host);
            CHECK((signal_number == SIGSTOP ? WIFSTOPPED(status) : WIFSIGNALED(status)));
            result.stopped = true;
        }
    }
    if (!result.stopped || signal_number == SIGSTOP) {
        kill(host, SIGKILL);
        waitpid(host, nullptr, 0);
    }
    close(sockets[0]);
    return result;
}

} // namespace

TEST_CASE(
    "host killed or stopped: the firmware holds minimum tension at 20 ms and lets go at 50 ms") {
    for (const DeviceState state :
         {DeviceState::active, DeviceState::taut, DeviceState::calibrated}) {
        for (const int signal_number : {SIGKILL, SIGSTOP}) {
            const Released found = stop_host(state, signal_number);
            MESSAGE(std::string(describe(state))
                    << (signal_number == SIGKILL ? " SIGKILL" : " SIGSTOP") << ": pulled "
                    << found.pulled_mn << " mN; minimum tension " << 1e-3 * found.held_us
                    << " ms and motors off " << 1e-3 * found.off_us
                    << " ms after the last command");
            REQUIRE(found.stopped);
            CHECK(found.held_us > 0);
            // The tensions fall with the firmware's slew limit from the end of validity on: 1 N/ms.
            CHECK(found.held_us <= kValid_ms * 1000U + found.pulled_mn + 1000U);
            CHECK(found.off_us >= 40'000);
            CHECK(found.off_us <= 51'000);
            CHECK(found.most_after_mn <= spidar::test::FirmwareSettings().limits.max_tension_mn);
        }
    }
}

#endif
