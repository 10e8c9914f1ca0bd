// Ports and their bridges, as a folder that looks like Linux's /sys tells of them. Its links need a system that has links:
// Windows' registry, which lists the ports there, has none.
#ifndef _WIN32
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "device/serial/serial_port.h"

using namespace spidar;
namespace fs = std::filesystem;

namespace {

// Removed at its end.
struct FakeSystem {
    fs::path root = fs::temp_directory_path() / "spidar_fake_sys";
    std::string sys = (root / "sys").string();
    std::string dev = (root / "dev").string();

    FakeSystem() {
        fs::remove_all(root);
        fs::create_directories(root / "sys/class/tty");
        fs::create_directories(root / "dev");
    }
    ~FakeSystem() { fs::remove_all(root); }
    FakeSystem(const FakeSystem &) = delete;
    FakeSystem &operator=(const FakeSystem &) = delete;

    static void write(const fs::path &file, const std::string &text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text << "\n";
    }
    // The port's device lies two folders below that of its bridge.
    void plug(const std::string &name, const std::string &product, const std::string &serial) {
        const fs::path bridge = root / "sys/devices/usb1" / name;
        write(bridge / "idVendor", "0403");
        write(bridge / "product", product);
        write(bridge / "serial", serial);
        const fs::path port = bridge / "interface" / name;
        write(port / "latency_timer", "16");
        add(name, port);
    }
    void add(const std::string &name, const fs::path &port) {
        fs::create_directories(port);
        fs::create_directories(root / "sys/class/tty" / name);
        fs::create_directory_symlink(port, root / "sys/class/tty" / name / "device");
        std::ofstream(root / "dev" / name) << "";
    }
};

} // namespace

TEST_CASE("serial ports: those of bridges come first, with their names") {
    FakeSystem system;
    system.add("ttyS0", system.root / "sys/devices/platform/a/b/c/serial8250");
    system.plug("ttyUSB0", "FT232R USB UART", "A50285BI");
    fs::create_directories(system.root / "sys/class/tty/tty1"); // a console: no device
    const auto ports = list_serial_ports(system.sys, system.dev);
    REQUIRE(ports.size() == 2);
    CHECK(describe(ports[0]) == "FT232R USB UART (serial A50285BI) at " + system.dev + "/ttyUSB0");
    CHECK(ports[0].usb);
    CHECK(describe(ports[1]) == "serial port at " + system.dev + "/ttyS0");
    CHECK(!ports[1].usb);
}

TEST_CASE("serial ports: the only one of a bridge is taken, of several none") {
    FakeSystem system;
    std::string path;
    std::string problem;
    system.add("ttyS0", system.root / "sys/devices/platform/serial8250");
    CHECK(choose_serial_port("", path, problem, system.sys, system.dev) == Status::no_device);
    system.plug("ttyUSB0", "FT232R USB UART", "A1");
    CHECK(choose_serial_port("", path, problem, system.sys, system.dev) == Status::ok);
    CHECK(path == system.dev + "/ttyUSB0");
    system.plug("ttyUSB1", "FT232R USB UART", "A2");
    CHECK(choose_serial_port("", path, problem, system.sys, system.dev) ==
          Status::invalid_settings);
    CHECK(problem.find("serial A1") != std::string::npos);
    CHECK(problem.find("serial A2") != std::string::npos);
    CHECK(choose_serial_port("/dev/this", path, problem, system.sys, system.dev) == Status::ok);
    CHECK(path == "/dev/this");
}

TEST_CASE("serial ports: a bridge's latency is set, or told") {
    FakeSystem system;
    system.plug("ttyUSB0", "FT232R USB UART", "A1");
    const std::string path = system.dev + "/ttyUSB0";
    const fs::path timer = fs::path(system.sys) / "class/tty/ttyUSB0/device/latency_timer";
    std::string problem;
    CHECK(shorten_latency(path, -1, problem, system.sys) == BridgeLatency::short_one);
    CHECK(problem.empty());
    std::ifstream file(timer);
    int now_ms = 0;
    file >> now_ms;
    CHECK(now_ms == 1);
    CHECK(shorten_latency(system.dev + "/ttyACM0", -1, problem, system.sys) ==
          BridgeLatency::not_known);
#ifdef __linux__
    // A number that nobody may write, not even root.
    fs::remove(timer);
    fs::create_symlink("/proc/sys/kernel/cap_last_cap", timer);
    CHECK(shorten_latency(path, -1, problem, system.sys) == BridgeLatency::long_one);
    CHECK(problem.find(" ms, which is too long") != std::string::npos);
    CHECK(problem.find(timer.string()) != std::string::npos);
#endif
}
#endif
