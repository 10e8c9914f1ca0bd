// SerialPort with asio. Each handle has its own context, which runs only inside read() and write().
#include "device/serial/serial_port.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>

#ifdef __SANITIZE_THREAD__
// Each asio context runs in one thread at a time, so that asio's fences, which this sanitizer does
// not know, order nothing.
#pragma GCC diagnostic ignored "-Wtsan"
#endif
#define ASIO_STANDALONE
#define ASIO_NO_DEPRECATED
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/serial_port.hpp>
#include <asio/write.hpp>

#ifndef _WIN32
#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace spidar {

namespace {

using Native = asio::serial_port::native_handle_type;

class AsioPort final : public SerialPort {
public:
    ~AsioPort() override {
#ifndef _WIN32
        if (claimed) { // a pseudo-terminal would stay locked
            (void)ioctl(port_.native_handle(), TIOCNXCL);
        }
#endif
        asio::error_code ignored;
        port_.close(ignored);
        run_for(0);
    }

    int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept override {
        if (!is_reading_ && !failed_) {
            read_on();
        }
        run_for(0);
        if (filled_ == 0 && timeout_ms > 0 && !failed_) {
            run_for(timeout_ms);
        }
        if (filled_ == 0) {
            return failed_ ? -1 : 0;
        }
        const std::size_t count = std::min(filled_, bytes.size());
        std::copy_n(came_.begin(), count, bytes.begin());
        std::copy(came_.begin() + static_cast<std::ptrdiff_t>(count),
                  came_.begin() + static_cast<std::ptrdiff_t>(filled_), came_.begin());
        filled_ -= count;
        return static_cast<int>(count);
    }

    bool write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept override {
        enum class Outcome { under_way, done, failed };
        Outcome outcome = Outcome::under_way;
        try {
            io_.restart();
            asio::async_write(port_, asio::buffer(bytes.data(), bytes.size()),
                              [&outcome](const asio::error_code &error, std::size_t) {
                                  outcome = error ? Outcome::failed : Outcome::done;
                              });
            const auto end =
                std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
            while (outcome == Outcome::under_way && io_.run_one_until(end) > 0) {
            }
            if (outcome == Outcome::under_way) {
                port_.cancel();
                io_.restart();
                while (outcome == Outcome::under_way && io_.run_one() > 0) { // it was cancelled
                }
                return false;
            }
        } catch (const std::exception &) { // no memory, or the port is gone
            return false;
        }
        return outcome == Outcome::done;
    }

    std::unique_ptr<SerialPort> another() noexcept override {
        try {
            auto copy = std::make_unique<AsioPort>();
            copy->port_.assign(duplicate(port_.native_handle()));
            return copy;
        } catch (const std::exception &) {
            return nullptr;
        }
    }

    [[nodiscard]] int descriptor() noexcept override {
#ifdef _WIN32
        return -1;
#else
        return port_.native_handle();
#endif
    }

    asio::serial_port &port() noexcept {
        return port_;
    }
    bool claimed = false; // no other process may open it

private:
    static Native duplicate(Native native) {
#ifdef _WIN32
        HANDLE copy = nullptr;
        const HANDLE process = GetCurrentProcess();
        DuplicateHandle(process, native, process, &copy, 0, FALSE, DUPLICATE_SAME_ACCESS);
        return copy;
#else
        return fcntl(native, F_DUPFD_CLOEXEC, 0);
#endif
    }

    // Runs handlers that become ready within the time; with 0, those that are ready.
    void run_for(int timeout_ms) noexcept {
        try {
            io_.restart();
            if (timeout_ms > 0) {
                io_.run_one_for(std::chrono::milliseconds(timeout_ms));
            }
            io_.poll();
        } catch (const std::exception &) {
            failed_ = true;
        }
    }

    void read_on() noexcept {
        try {
            is_reading_ = true;
            port_.async_read_some(asio::buffer(chunk_),
                                  [this](const asio::error_code &error, std::size_t count) {
                                      arrived(error, count);
                                  });
        } catch (const std::exception &) {
            failed_ = true;
        }
    }

    void arrived(const asio::error_code &error, std::size_t count) noexcept {
        is_reading_ = false;
        // The oldest unread bytes are dropped; the reader resynchronizes.
        if (count > came_.size() - filled_) {
            filled_ = 0;
        }
        std::copy_n(chunk_.begin(), count, came_.begin() + static_cast<std::ptrdiff_t>(filled_));
        filled_ += count;
        failed_ = failed_ || error;
        if (!failed_) {
            read_on();
        }
    }

    asio::io_context io_{1};
    asio::serial_port port_{io_};
    std::array<std::uint8_t, 512> chunk_{};
    std::array<std::uint8_t, 4096> came_{};
    std::size_t filled_ = 0;
    bool is_reading_ = false;
    bool failed_ = false;
};

Status status_of(const asio::error_code &error) {
    switch (error.value()) { // error number of the system
#ifdef _WIN32
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
        return Status::no_device;
    case ERROR_ACCESS_DENIED: // on Windows another program has the port
        return Status::device_in_use;
#else
    case ENOENT:
    case ENODEV:
    case ENXIO:
        return Status::no_device;
    case EACCES:
    case EPERM:
        return Status::no_permission;
    case EBUSY:
        return Status::device_in_use;
#endif
    default:
        return Status::open_failed;
    }
}

std::string remedy(Status status) {
    switch (status) {
    case Status::no_device:
        return "This port does not exist; plug the device in, or choose a port that is listed.";
    case Status::no_permission:
        return "This user has no permission to open the port; install "
               "addons/spidar_g/udev/70-spidar-g.rules and plug the device in again, or add the "
               "user to the group that owns the port (dialout).";
    case Status::device_in_use:
        return "Another program has the port open; close that program (a terminal, ModemManager, "
               "another game).";
    default:
        return "The port does not open as a serial port of this speed; choose another port.";
    }
}

// Locks the port for this process. Returns false when somebody else has it.
bool claim(asio::serial_port &port) {
#ifdef _WIN32
    (void)port; // Windows opens serial ports for one program only
    return true;
#else
    const int descriptor = port.native_handle();
    (void)fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    (void)ioctl(descriptor, TIOCEXCL); // a system without it still has the lock
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
#endif
}

} // namespace

std::unique_ptr<SerialPort> open_serial_port(const std::string &path, std::uint32_t baud,
                                             Status &status, std::string &problem) {
    auto made = std::make_unique<AsioPort>();
    asio::serial_port &port = made->port();
    asio::error_code error;
    port.open(path, error);
    status = error ? status_of(error) : Status::ok;
    if (!error && !claim(port)) {
        status = Status::device_in_use;
    }
    if (usable(status)) {
        using Base = asio::serial_port_base;
        port.set_option(Base::baud_rate(baud), error);
        const auto set = [&](const auto &option) {
            if (!error) {
                port.set_option(option, error);
            }
        };
        set(Base::character_size(8));
        set(Base::parity(Base::parity::none));
        set(Base::stop_bits(Base::stop_bits::one));
        set(Base::flow_control(Base::flow_control::none));
        status = error ? Status::open_failed : Status::ok;
    }
    if (!usable(status)) {
        problem = "Port " + path + ": " + remedy(status) +
                  (error ? " (" + error.message() + ")" : std::string());
        return nullptr;
    }
    problem.clear();
    made->claimed = true;
    return made;
}

} // namespace spidar
