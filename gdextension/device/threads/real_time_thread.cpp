#include "device/threads/real_time_thread.h"

#include <chrono>

#if defined(__linux__)
#include <cerrno>
#include <ctime>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#endif

#if defined(__SSE2__) || defined(_M_X64)
#include <immintrin.h>
#endif

namespace spidar {

std::int64_t monotonic_ns() noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

#if defined(__linux__)

void sleep_until_ns(std::int64_t deadline_ns) noexcept {
    // steady_clock is CLOCK_MONOTONIC here.
    constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
    timespec until{};
    until.tv_sec = static_cast<std::time_t>(deadline_ns / kNanosecondsPerSecond);
    until.tv_nsec = static_cast<long>(deadline_ns % kNanosecondsPerSecond);
    // A signal ends the sleep early; the loop continues it to the deadline.
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

bool request_real_time() noexcept {
    // Linux delays wake-ups of ordinary threads by up to 50 us to save power; 1 ns switches that
    // off.
    constexpr unsigned long kTimerSlack_ns = 1;
    prctl(PR_SET_TIMERSLACK, kTimerSlack_ns, 0UL, 0UL, 0UL);
    // Above ordinary threads, below the kernel's own interrupt threads (50).
    constexpr int kPriority = 40;
    sched_param parameter{};
    parameter.sched_priority = kPriority;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0;
}

void name_thread(const char *name) noexcept {
    prctl(PR_SET_NAME, name, 0UL, 0UL, 0UL);
}

#endif // Windows: real_time_thread_windows.cpp

#if defined(__SSE2__) || defined(_M_X64)

FlushDenormals::FlushDenormals() noexcept : saved_(_mm_getcsr()) {
    constexpr unsigned int kFlushToZero = 0x8000;
    constexpr unsigned int kDenormalsAreZero = 0x0040;
    _mm_setcsr(static_cast<unsigned int>(saved_) | kFlushToZero | kDenormalsAreZero);
}

FlushDenormals::~FlushDenormals() {
    _mm_setcsr(static_cast<unsigned int>(saved_));
}

#elif defined(__aarch64__) && defined(__GNUC__)

FlushDenormals::FlushDenormals() noexcept {
    constexpr std::uint64_t kFlushToZero = std::uint64_t{1} << 24;
    asm volatile("mrs %0, fpcr" : "=r"(saved_));
    asm volatile("msr fpcr, %0" : : "r"(saved_ | kFlushToZero));
}

FlushDenormals::~FlushDenormals() {
    asm volatile("msr fpcr, %0" : : "r"(saved_));
}

#else

FlushDenormals::FlushDenormals() noexcept = default;
FlushDenormals::~FlushDenormals() {
    (void)saved_;
}

#endif

} // namespace spidar
