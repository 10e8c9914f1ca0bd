#include "device/threads/writer_thread.h"

#include <chrono>
#include <system_error>

#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

// How often a thread that has nothing to write looks whether the loop still lives.
constexpr std::chrono::milliseconds kLook(5);

} // namespace

Status WriterThread::start() noexcept {
    stop_asked_.store(false);
    forbidden_.store(false);
    stalled_.store(false);
    result_.store(0);
    writing_since_ns_.store(0);
    last_post_ns_.store(monotonic_ns());
    motors_are_on_ = false;
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error &) {
        return Status::open_failed;
    }
    return Status::ok;
}

void WriterThread::stop() noexcept {
    if (!thread_.joinable()) {
        return;
    }
    stop_asked_.store(true, std::memory_order_release);
    posted_.release();
    thread_.join();
}

void WriterThread::post(const DriveCommand &command) noexcept {
    mailbox_.write(command);
    last_post_ns_.store(monotonic_ns(), std::memory_order_release);
    posted_.release();
}

void WriterThread::forbid() noexcept {
    forbidden_.store(true, std::memory_order_release);
    posted_.release();
}

Status WriterThread::take_result() noexcept {
    return static_cast<Status>(result_.exchange(0, std::memory_order_acq_rel));
}

std::int64_t WriterThread::blocked_ns(std::int64_t now_ns) const noexcept {
    const std::int64_t since_ns = writing_since_ns_.load(std::memory_order_acquire);
    return since_ns != 0 && now_ns > since_ns ? now_ns - since_ns : 0;
}

void WriterThread::write(const DriveCommand &command) noexcept {
    writing_since_ns_.store(monotonic_ns(), std::memory_order_release);
    const Status status = transport_.write(command);
    writing_since_ns_.store(0, std::memory_order_release);
    motors_are_on_ = usable(status) && command.motors_on;
    if (!usable(status)) {
        result_.store(static_cast<std::int32_t>(status), std::memory_order_release);
    }
}

void WriterThread::run() noexcept {
    name_thread("spidar_writer");
    (void)request_real_time();
    DriveCommand command;
    while (!stop_asked_.load(std::memory_order_acquire)) {
        (void)posted_.try_acquire_for(kLook);
        while (posted_.try_acquire()) { // newest only: posts that came meanwhile are one
        }
        const bool fresh = mailbox_.read(command);
        if (forbidden_.load(std::memory_order_acquire)) {
            if (motors_are_on_ || fresh) {
                write(DriveCommand());
            }
        } else if (fresh) {
            write(command);
        } else if (motors_are_on_ &&
                   monotonic_ns() - last_post_ns_.load(std::memory_order_acquire) > kStalled_ns) {
            write(DriveCommand());
            stalled_.store(true, std::memory_order_release);
        }
    }
    write(DriveCommand());
}

} // namespace spidar
