// Opens the serial motor boards of given settings for one owner in this process.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "device/contract/device_claims.h"
#include "device/serial/serial_transport.h"

namespace spidar {

// Returns the open device. Returns null with `status` and `problem` otherwise; `problem` begins
// with "serial_port" when that setting is at fault. `claim` owns the port in the name of `owner`.
// Takes up to half a second.
[[nodiscard]] std::unique_ptr<SerialTransport>
open_serial_device(SerialTransportSettings settings, const std::string &owner, DeviceClaim &claim,
                   Status &status, std::string &problem);

// Looks for the boards in its own thread until they are found, and keeps them open until take().
class SerialSearch {
public:
    // Pause between two searches.
    static constexpr std::chrono::milliseconds kPause{500};

    SerialSearch(const SerialTransportSettings &settings, std::string owner);
    // Interrupts a search in progress.
    ~SerialSearch();
    SerialSearch(const SerialSearch &) = delete;
    SerialSearch &operator=(const SerialSearch &) = delete;

    // Returns the open device once; null while none is found. The port then has no owner in this
    // process. Never waits.
    [[nodiscard]] std::unique_ptr<SerialTransport> take();
    // Returns the reason why the last search failed. Returns false when no search has ended since
    // the last call. Never waits.
    [[nodiscard]] bool take_failure(Status &status, std::string &problem);

private:
    void run();
    [[nodiscard]] bool look();
    void keep_found();

    const SerialTransportSettings settings_;
    const std::string owner_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_; // guards all members below
    std::condition_variable wake_;
    DeviceClaim claim_; // claim of found_
    std::unique_ptr<SerialTransport> found_;
    bool failed_ = false;
    Status status_ = Status::ok;
    std::string problem_;
    std::thread thread_;
};

} // namespace spidar
