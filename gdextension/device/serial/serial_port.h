// Access to the system's serial ports: list, choose, open, read and write.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"

namespace spidar {

struct SerialPortInfo {
    std::string path;    // system path, such as /dev/ttyUSB0
    std::string product; // product string of the USB bridge; empty without one
    std::string serial;  // serial number of the USB bridge; empty without one
    bool usb = false;
};

// A handle on an open port; the destructor closes the handle. Each thread needs a handle of its own
// (another()).
class SerialPort {
public:
    SerialPort() = default;
    SerialPort(const SerialPort &) = delete;
    SerialPort &operator=(const SerialPort &) = delete;
    virtual ~SerialPort() = default;

    // Reads received bytes. Returns their number, 0 when none arrive within timeout_ms (0: no
    // waiting), or -1 when the port is gone or fails.
    virtual int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // Returns false when the port is gone, fails or does not take all bytes within timeout_ms.
    virtual bool write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // Returns a second handle on the same port; null on failure.
    virtual std::unique_ptr<SerialPort> another() noexcept = 0;
    // Returns the file descriptor, which a child process can inherit; -1 on Windows.
    [[nodiscard]] virtual int descriptor() noexcept = 0;
};

// Opens the port for this process alone, with eight data bits, one stop bit, no parity and no flow
// control. On failure returns null, with no_device, no_permission, device_in_use or open_failed in
// `status`, and a sentence with a remedy in `problem`.
[[nodiscard]] std::unique_ptr<SerialPort>
open_serial_port(const std::string &path, std::uint32_t baud, Status &status, std::string &problem);

// Lists the serial ports that have hardware, those of USB bridges first. sys and dev: system
// folders, which tests replace. Returns an empty list on systems other than Linux, where the user
// must name the port.
[[nodiscard]] std::vector<SerialPortInfo> list_serial_ports(const std::string &sys = "/sys",
                                                            const std::string &dev = "/dev");
// Returns the name of the boards on a port, as in Transport::device_name().
[[nodiscard]] inline std::string serial_device_name(const std::string &path) {
    return "serial:" + path;
}
// Sets `path` to `wanted` or, if `wanted` is empty, to the only port of a USB bridge. Without such
// a port returns no_device; with several, invalid_settings and a list of them in `problem`.
[[nodiscard]] Status choose_serial_port(const std::string &wanted, std::string &path,
                                        std::string &problem, const std::string &sys = "/sys",
                                        const std::string &dev = "/dev");
// Returns a text such as "FT232R (serial A50285BI) at /dev/ttyUSB0".
[[nodiscard]] std::string describe(const SerialPortInfo &port);

// How long a USB bridge holds received bytes before it sends them on.
enum class BridgeLatency : std::uint8_t {
    not_known, // the system does not report it for this port
    short_one, // at most 1 ms, set now or before
    long_one,  // longer than 1 ms
};
// Tries to set the latency to 1 ms. If it stays longer, `problem` holds the remedy. descriptor: of
// the open port; -1: none.
[[nodiscard]] BridgeLatency shorten_latency(const std::string &path, int descriptor,
                                            std::string &problem, const std::string &sys = "/sys");

} // namespace spidar
