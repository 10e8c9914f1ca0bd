#include "device/threads/writer_thread.h"

#include <chrono>
#include <system_error>

#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

// Interval at which an idle thread checks the loop and repeats the off command.
constexpr std::chrono::milliseconds kLook(5);
constexpr std::chrono::milliseconds kTryAgain(1);

} // namespace

Status WriterThread::start() noexcept {
    stop_asked_.store(false);
    forbidden_.store(false);
    stalled_.store(false);
    result_.store(0);
    writing_since_ns_.store(0);
    last_post_ns_.store(monotonic_ns());
    forget_posts();
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error &) {
        return Status::open_failed;
    }
    return Status::ok;
}

void WriterThread::forget_posts() noexcept {
    DriveCommand stale;
    (void)mailbox_.read(stale);
    while (posted_.try_acquire()) {
    }
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

bool WriterThread::stands_still() const noexcept {
    return monotonic_ns() - last_post_ns_.load(std::memory_order_acquire) > kStalled_ns;
}

Status WriterThread::write(const DriveCommand &command) noexcept {
    writing_since_ns_.store(monotonic_ns(), std::memory_order_release);
    const Status status = transport_.write(command);
    writing_since_ns_.store(0, std::memory_order_release);
    off_is_wanted_ = !command.motors_on;
    if (command.motors_on) {
        motors_may_be_on_ = true; // a write that failed may have arrived
    } else if (usable(status)) {
        motors_may_be_on_ = false;
    }
    return status;
}

void WriterThread::write_posted(const DriveCommand &command) noexcept {
    const Status status = write(command);
    if (!usable(status)) {
        result_.store(static_cast<std::int32_t>(status), std::memory_order_release);
    }
}

void WriterThread::look() noexcept {
    DriveCommand command;
    const bool fresh = mailbox_.read(command);
    if (fresh) {
        const bool forbidden = forbidden_.load(std::memory_order_acquire);
        write_posted(forbidden ? DriveCommand() : command);
        return;
    }
    if (!motors_may_be_on_) {
        return;
    }
    if (!off_is_wanted_ && stands_still()) {
        // Set first, so that posts of a loop that wakes up again are refused too.
        forbidden_.store(true, std::memory_order_release);
        write_off();
        stalled_.store(true, std::memory_order_release);
    } else if (off_is_wanted_ || forbidden_.load(std::memory_order_acquire)) {
        write_off();
    }
}

void WriterThread::run() noexcept {
    name_thread("spidar_writer");
    (void)request_real_time();
    while (!stop_asked_.load(std::memory_order_acquire)) {
        (void)posted_.try_acquire_for(kLook);
        while (posted_.try_acquire()) { // posts that arrived meanwhile count as one
        }
        look();
    }
    const std::int64_t patient_until_ns = monotonic_ns() + kStopPatience_ns;
    write_off();
    while (motors_may_be_on_ && monotonic_ns() < patient_until_ns) {
        std::this_thread::sleep_for(kTryAgain);
        write_off();
    }
}

} // namespace spidar
