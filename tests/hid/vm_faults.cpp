// The host dies in contact; an OUT endpoint hangs. The first through /dev/uhid, the second through the kernel's USB
// gadget driver, its HID function and dummy_hcd.
#include <doctest/doctest.h>

#include <cstdio>

#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

#include "hid/uhid_device.h"
#include "hid/usb_gadget.h"
#include "hid/vm_host.h"

using namespace spidar;
using spidar::test::DeviceObservations;
using spidar::test::FirmwareModel;
using spidar::test::GadgetDevice;
using spidar::test::sleep_ms;
using spidar::test::UhidDevice;
using spidar::test::VmHost;

namespace {

constexpr double kMillisecond_ns = 1e6;
constexpr std::uint16_t kPulling_mn = 600; // above minimum tension
// The firmware's watchdog counts from the last command that it got, and looks once a report. A command that was written just
// before the kill is still under way then, so that both may add up to one period of the reports.
constexpr double kUnderWay_ms = 1.0;

void figure(const char *what, double value, const char *unit) {
    std::printf("figure: %s = %.3f %s\n", what, value, unit);
    std::fflush(stdout);
}

// The first sample from `from_ns` on after which every motor stays at or below `limit_mn`; ms after from_ns, -1: never.
double settled_ms(const DeviceObservations &seen, std::int64_t from_ns, std::uint16_t limit_mn) {
    double settled = -1.0;
    for (const auto &sample : seen.motors) {
        if (sample.time_ns < from_ns) {
            continue;
        }
        if (sample.strongest_mn > limit_mn) {
            settled = -1.0;
        } else if (settled < 0.0) {
            settled = static_cast<double>(sample.time_ns - from_ns) / kMillisecond_ns;
        }
    }
    return settled;
}

} // namespace

TEST_CASE("vm: the host is killed in contact: minimum tension 20 ms after its last command, "
          "nothing 50 ms after") {
    UhidDevice device({});
    REQUIRE(device.plug());
    sleep_ms(100.0);
    const pid_t host = fork();
    REQUIRE(host >= 0);
    if (host == 0) {
        execl("/proc/self/exe", "spidar_hid_vm", "--host", "VM-1", nullptr);
        _exit(127);
    }
    for (int i = 0; i < 300; ++i) {
        sleep_ms(10.0);
        const DeviceObservations seen = device.observations();
        if (!seen.motors.empty() && seen.motors.back().strongest_mn > kPulling_mn) {
            break;
        }
    }
    sleep_ms(300.0);
    device.clear_observations();
    sleep_ms(20.0);
    REQUIRE(device.observations().motors.back().strongest_mn > kPulling_mn);
    const std::int64_t killed_ns = test::now_ns();
    kill(host, SIGKILL);
    waitpid(host, nullptr, 0);
    sleep_ms(100.0);
    const DeviceObservations seen = device.observations();
    const double minimum_ms = settled_ms(seen, killed_ns, 300);
    const double zero_ms = settled_ms(seen, killed_ns, 0);
    figure("SIGKILL -> minimum tension", minimum_ms, "ms");
    figure("SIGKILL -> motors at zero", zero_ms, "ms");
    CHECK(minimum_ms >= 0.0);
    CHECK(minimum_ms <= 20.0 + kUnderWay_ms);
    CHECK(zero_ms > minimum_ms);
    CHECK(zero_ms <= 50.0 + kUnderWay_ms);
    CHECK(device.with_firmware([](const FirmwareModel &f) { return f.counters().trips; }) == 1);

    VmHost next("VM-1"); // the next game finds a device that it can clear and use
    REQUIRE(next.start() == Status::ok);
    CHECK(next.activate(3.0));
}

TEST_CASE(
    "vm: an OUT endpoint that stops answering: the loop keeps its period and faults in time") {
    GadgetDevice device;
    REQUIRE(device.plug());
    VmHost host("VM-USB", device.bus());
    REQUIRE(host.start() == Status::ok);
    REQUIRE(host.activate(3.0));
    const std::uint64_t ticks_before = host.look().counters.ticks;
    const std::uint64_t missed_before = host.loop.statistics().missed_deadlines;
    const std::int64_t from_ns = test::now_ns();
    device.stop_taking_commands();
    const std::int64_t fault_ns = host.wait_for(
        [](const ServoSnapshot &s) {
            return s.state == DeviceState::fault || s.state == DeviceState::closed;
        },
        0.5);
    REQUIRE(fault_ns > 0);
    figure("OUT endpoint hangs -> fault", static_cast<double>(fault_ns - from_ns) / kMillisecond_ns,
           "ms");
    CHECK(static_cast<double>(fault_ns - from_ns) <= 60.0 * kMillisecond_ns);
    for (const double tension_n : host.snapshot.tensions_n) {
        CHECK(tension_n == 0.0);
    }
    host.pull(1.0);
    const double seconds = static_cast<double>(test::now_ns() - from_ns) * 1e-9;
    const auto ticks = static_cast<double>(host.look().counters.ticks - ticks_before);
    figure("cycles a second while it hangs", ticks / seconds, "Hz");
    CHECK(ticks / seconds >= 995.0);
    CHECK(host.loop.statistics().missed_deadlines - missed_before <= 5);
    CHECK(device.observations().motors.back().strongest_mn == 0); // its own watchdog
}
