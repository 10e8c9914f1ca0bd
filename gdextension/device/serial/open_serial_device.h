// Opens the device with serial motor boards that the settings describe, for one owner in this
// process.
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

// Returns the open device; `claim` then holds the port in the name of `owner`. On failure returns
// null with `status` and `problem`; `problem` begins with "serial_port" if no port could be chosen.
// Blocks while it asks the boards.
[[nodiscard]] std::unique_ptr<SerialTransport>
open_serial_device(SerialTransportSettings settings, const std::string &owner, DeviceClaim &claim,
                   Status &status, std::string &problem);

// Looks for the boards in a thread until they are found, and keeps them open until take().
class SerialSearch {
public:
    // Pause between two searches.
    static constexpr std::chrono::milliseconds kPause{500};

    SerialSearch(const SerialTransportSettings &settings, std::string owner);
    // Interrupts a search in progress and closes the boards unless take() returned them.
    ~SerialSearch();
    SerialSearch(const SerialSearch &) = delete;
    SerialSearch &operator=(const SerialSearch &) = delete;

    // Returns the open device, once; returns null before it is found. The caller must claim the
    // port, which has no owner after this call. Never waits: returns null while the thread is busy.
    [[nodiscard]] std::unique_ptr<SerialTransport> take();
    // Returns true and the reason if a search has failed since the last call, else false. Never
    // waits: returns false while the thread is busy.
    [[nodiscard]] bool take_failure(Status &status, std::string &problem);

private:
    void run();
    [[nodiscard]] bool look();
    void keep_found();

    const SerialTransportSettings settings_;
    const std::string owner_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_; // guards the members from claim_ to problem_
    std::condition_variable wake_;
    DeviceClaim claim_; // claim of found_
    std::unique_ptr<SerialTransport> found_;
    bool failed_ = false;
    Status status_ = Status::ok;
    std::string problem_;
    std::thread thread_;
};

} // namespace spidar
