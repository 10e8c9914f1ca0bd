// Opens the serial motor boards that settings name, for one owner in this process.
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

// Open, or null: `status` and `problem` say why. `problem` begins with "serial_port" when that setting is at fault. `claim`
// owns the port in the name of `owner`. Takes up to half a second.
[[nodiscard]] std::unique_ptr<SerialTransport>
open_serial_device(SerialTransportSettings settings, const std::string &owner, DeviceClaim &claim,
                   Status &status, std::string &problem);

// Looks for the boards in a thread of its own until they are found, and keeps them open until they are fetched.
class SerialSearch {
public:
    static constexpr std::chrono::milliseconds kPause{
        500}; // between the end of a look and the next

    SerialSearch(const SerialTransportSettings &settings, std::string owner);
    // A look that is under way is broken off.
    ~SerialSearch();
    SerialSearch(const SerialSearch &) = delete;
    SerialSearch &operator=(const SerialSearch &) = delete;

    // Never waits. The open device, once; null: not found yet. Nobody in this process owns it then.
    [[nodiscard]] std::unique_ptr<SerialTransport> take();
    // Never waits. Why the newest look failed. False: no look has ended since the last call.
    [[nodiscard]] bool take_failure(Status &status, std::string &problem);

private:
    void run();
    [[nodiscard]] bool look();
    void keep_found();

    const SerialTransportSettings settings_;
    const std::string owner_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_; // all below
    std::condition_variable wake_;
    DeviceClaim claim_; // of found_
    std::unique_ptr<SerialTransport> found_;
    bool failed_ = false;
    Status status_ = Status::ok;
    std::string problem_;
    std::thread thread_;
};

} // namespace spidar
