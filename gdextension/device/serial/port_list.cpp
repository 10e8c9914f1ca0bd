// Serial ports of Linux in /sys: names of their USB bridges, and the latency timer of FTDI bridges.
#include "device/serial/serial_port.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#ifdef __linux__
#include <linux/serial.h>
#include <sys/ioctl.h>
#endif

namespace spidar {

namespace {

namespace fs = std::filesystem;

constexpr int kLevelsToBridge = 4; // from a port's device up to its USB device
constexpr int kShort_ms = 1;

std::string first_line(const fs::path &file) {
    std::ifstream input(file);
    std::string line;
    std::getline(input, line);
    return line;
}

std::string latency_file(const std::string &path, const std::string &sys) {
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    const fs::path name = error ? fs::path(path).filename() : real.filename();
    return sys + "/class/tty/" + name.string() + "/device/latency_timer";
}

// Returns -1 when the timer is unknown.
int latency_ms(const std::string &file) {
    std::ifstream input(file);
    int value = -1;
    return input >> value ? value : -1;
}

void ask_for_low_latency(int descriptor) {
#ifdef __linux__
    serial_struct settings{};
    if (descriptor >= 0 && ioctl(descriptor, TIOCGSERIAL, &settings) == 0) {
        settings.flags |= ASYNC_LOW_LATENCY;
        (void)ioctl(descriptor, TIOCSSERIAL, &settings); // the file shows whether this worked
    }
#else
    (void)descriptor;
#endif
}

} // namespace

std::vector<SerialPortInfo> list_serial_ports(const std::string &sys, const std::string &dev) {
    std::vector<SerialPortInfo> ports;
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(sys + "/class/tty", error)) {
        const std::string name = entry.path().filename().string();
        fs::path device = fs::canonical(entry.path() / "device", error);
        if (error || !fs::exists(fs::path(dev) / name, error)) {
            continue; // a console, or a port that has no hardware
        }
        SerialPortInfo port;
        port.path = (fs::path(dev) / name).string();
        for (int level = 0; level < kLevelsToBridge && !port.usb; ++level) {
            port.usb = fs::exists(device / "idVendor", error);
            if (port.usb) {
                port.product = first_line(device / "product");
                port.serial = first_line(device / "serial");
            }
            device = device.parent_path();
        }
        ports.push_back(port);
    }
    std::sort(ports.begin(), ports.end(), [](const SerialPortInfo &a, const SerialPortInfo &b) {
        return a.usb != b.usb ? a.usb : a.path < b.path;
    });
    return ports;
}

std::string describe(const SerialPortInfo &port) {
    const std::string name = port.product.empty() ? "serial port" : port.product;
    return name + (port.serial.empty() ? "" : " (serial " + port.serial + ")") + " at " + port.path;
}

Status choose_serial_port(const std::string &wanted, std::string &path, std::string &problem,
                          const std::string &sys, const std::string &dev) {
    path = wanted;
    if (!path.empty()) {
        return Status::ok;
    }
    std::string names;
    int found = 0;
    for (const SerialPortInfo &port : list_serial_ports(sys, dev)) {
        if (port.usb) {
            path = found == 0 ? port.path : path;
            names += (found == 0 ? "" : ", ") + describe(port);
            ++found;
        }
    }
    if (found == 1) {
        return Status::ok;
    }
    problem = found == 0
                  ? "No USB serial port is plugged in; plug in the motor boards or name the port."
                  : "Several serial ports are plugged in (" + names + "); choose one.";
    return found == 0 ? Status::no_device : Status::invalid_settings;
}

BridgeLatency shorten_latency(const std::string &path, int descriptor, std::string &problem,
                              const std::string &sys) {
    problem.clear();
    const std::string file = latency_file(path, sys);
    const int before_ms = latency_ms(file);
    if (before_ms < 0) {
        return BridgeLatency::not_known;
    }
    if (before_ms > kShort_ms) {
        ask_for_low_latency(descriptor);
    }
    if (latency_ms(file) > kShort_ms) {
        std::ofstream output(file); // needs write access
        output << kShort_ms;
    }
    const int now_ms = latency_ms(file);
    if (now_ms <= kShort_ms) {
        return BridgeLatency::short_one;
    }
    problem =
        "The USB bridge at " + path + " holds received data back for " + std::to_string(now_ms) +
        " ms, which is too long for forces, and this user has no permission to change it. Install "
        "addons/spidar_g/udev/70-spidar-g.rules and plug it in again, or write 1 to " +
        file + " as root.";
    return BridgeLatency::long_one;
}

} // namespace spidar
