// The system's serial ports as SerialTransport needs them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"

namespace spidar {

struct SerialPortInfo {
    std::string path;    // of the system: /dev/ttyUSB0
    std::string product; // of the USB bridge, as it says itself; empty where there is none
    std::string serial;  // the same
    bool usb = false;
};

// One thread at a time; another thread takes another(). Closed by its destructor.
class SerialPort {
public:
    SerialPort() = default;
    SerialPort(const SerialPort &) = delete;
    SerialPort &operator=(const SerialPort &) = delete;
    virtual ~SerialPort() = default;

    // What has come in: the number of bytes, 0 when none comes within the time (0: no waiting), -1 when the port is gone.
    virtual int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // False: the port is gone, or it took the bytes only in part within the time.
    virtual bool write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // A second handle on the same port; null on failure.
    virtual std::unique_ptr<SerialPort> another() noexcept = 0;
    // What a process started from here inherits; -1 where it cannot.
    [[nodiscard]] virtual int descriptor() noexcept = 0;
};

// Opens the port for this process alone, raw, with eight bits, no parity and no flow control. Null on failure: `status` is
// no_device, no_permission, device_in_use or open_failed, and `problem` a sentence with a remedy.
[[nodiscard]] std::unique_ptr<SerialPort>
open_serial_port(const std::string &path, std::uint32_t baud, Status &status, std::string &problem);

// All serial ports now there, those of USB bridges first. The folders are the system's unless a test brings its own.
// Empty on systems other than Linux: there a port is given by its name.
[[nodiscard]] std::vector<SerialPortInfo> list_serial_ports(const std::string &sys = "/sys",
                                                            const std::string &dev = "/dev");
// Under which the boards on a port are known, as Transport::device_name().
[[nodiscard]] inline std::string serial_device_name(const std::string &path) {
    return "serial:" + path;
}
// `wanted`, or if that is empty the only port of a USB bridge. no_device, invalid_settings: none, or several; `problem` names
// them.
[[nodiscard]] Status choose_serial_port(const std::string &wanted, std::string &path,
                                        std::string &problem, const std::string &sys = "/sys",
                                        const std::string &dev = "/dev");
// "FT232R (serial A50285BI) at /dev/ttyUSB0".
[[nodiscard]] std::string describe(const SerialPortInfo &port);

// How long a USB bridge keeps what it received before it sends it on.
enum class BridgeLatency : std::uint8_t {
    not_known, // no bridge that says so
    short_one, // 1 ms, now or before
    long_one,  // and it cannot be set: `problem` says how
};
// descriptor: of the open port, -1: none.
[[nodiscard]] BridgeLatency shorten_latency(const std::string &path, int descriptor,
                                            std::string &problem, const std::string &sys = "/sys");

} // namespace spidar
