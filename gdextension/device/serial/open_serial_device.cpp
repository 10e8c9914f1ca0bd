#include "device/serial/open_serial_device.h"

#include <exception>
#include <system_error>
#include <utility>

#include "device/serial/serial_port.h"

namespace spidar {

namespace {

// Well below the silence after which boards count as lost.
constexpr std::chrono::milliseconds kKeepAsking(5);

std::unique_ptr<SerialTransport> open_unless(const std::atomic<bool> &give_up,
                                             SerialTransportSettings settings,
                                             const std::string &owner, DeviceClaim &claim,
                                             Status &status, std::string &problem) {
    status = choose_serial_port(settings.port, settings.port, problem);
    if (!usable(status)) {
        problem = "serial_port: " + problem;
        return nullptr;
    }
    const std::string name = serial_device_name(settings.port);
    if (!claim.take(name, owner)) {
        status = Status::device_in_use;
        problem = "Port " + settings.port + " belongs to \"" + DeviceClaim::owner_of(name) +
                  "\": free it there, or set serial_port to another port.";
        return nullptr;
    }
    auto transport = std::make_unique<SerialTransport>(settings);
    status = transport->open_unless(give_up);
    if (!usable(status)) {
        problem = transport->problem();
        claim.release();
        return nullptr;
    }
    problem.clear();
    return transport;
}

} // namespace

std::unique_ptr<SerialTransport> open_serial_device(SerialTransportSettings settings,
                                                    const std::string &owner, DeviceClaim &claim,
                                                    Status &status, std::string &problem) {
    return open_unless(std::atomic<bool>{false}, std::move(settings), owner, claim, status,
                       problem);
}

SerialSearch::SerialSearch(const SerialTransportSettings &settings, std::string owner)
    : settings_(settings), owner_(std::move(owner)) {
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error &) { // no thread: devices plugged in later are not found
        stop_.store(true);
    }
}

SerialSearch::~SerialSearch() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stop_.store(true);
    }
    wake_.notify_all();
    if (thread_.joinable()) {
        thread_.join();
    }
}

std::unique_ptr<SerialTransport> SerialSearch::take() {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || !found_) {
        return nullptr;
    }
    claim_.release();
    return std::move(found_);
}

bool SerialSearch::take_failure(Status &status, std::string &problem) {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || !failed_) {
        return false;
    }
    failed_ = false;
    status = status_;
    problem = problem_;
    return true;
}

void SerialSearch::run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, kPause, [this] { return stop_.load(); })) {
        lock.unlock();
        bool found = false;
        try {
            found = look();
        } catch (const std::exception &) { // no memory: tried again at the next search
            found = false;
        }
        if (found) {
            keep_found();
            return;
        }
        lock.lock();
    }
}

bool SerialSearch::look() {
    Status status = Status::ok;
    std::string problem;
    DeviceClaim claim;
    auto transport = open_unless(stop_, settings_, owner_, claim, status, problem);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (transport) {
        claim.release();
        if (!claim_.take(transport->device_name(), owner_)) {
            return false; // another owner was faster
        }
        found_ = std::move(transport);
        return true;
    }
    failed_ = !stop_.load();
    status_ = status;
    problem_ = std::move(problem);
    return false;
}

// The lock is held for the millisecond of an exchange at most: take() succeeds in the next frame.
void SerialSearch::keep_found() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (found_ && !wake_.wait_for(lock, kKeepAsking, [this] { return stop_.load(); })) {
        if (found_) {
            found_->keep_asking();
        }
    }
}

} // namespace spidar
