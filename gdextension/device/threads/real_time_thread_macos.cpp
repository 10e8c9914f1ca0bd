// Timers and priority of macOS. Not tested: no such machine was at hand.
#include "device/threads/real_time_thread.h"

#if defined(__APPLE__)

#include <mach/mach.h>
#include <mach/mach_time.h>
#include <mach/thread_policy.h>
#include <pthread.h>

namespace spidar {

namespace {

// In the units of mach_absolute_time().
std::uint64_t mach_time(std::int64_t time_ns) noexcept {
    mach_timebase_info_data_t base{};
    mach_timebase_info(&base);
    return static_cast<std::uint64_t>(time_ns) * base.denom / base.numer;
}

} // namespace

void sleep_until_ns(std::int64_t deadline_ns) noexcept {
    // The two clocks count from different moments: what is left is the same on both.
    for (std::int64_t left_ns = deadline_ns - monotonic_ns(); left_ns > 0;
         left_ns = deadline_ns - monotonic_ns()) {
        mach_wait_until(mach_absolute_time() + mach_time(left_ns));
    }
}

bool request_real_time() noexcept {
    // A cycle of 1 ms that takes 0.1 ms and has to be over after 0.5 ms.
    constexpr std::int64_t kPeriod_ns = 1'000'000;
    constexpr std::int64_t kWork_ns = 100'000;
    constexpr std::int64_t kLatest_ns = 500'000;
    thread_time_constraint_policy_data_t policy{};
    policy.period = static_cast<std::uint32_t>(mach_time(kPeriod_ns));
    policy.computation = static_cast<std::uint32_t>(mach_time(kWork_ns));
    policy.constraint = static_cast<std::uint32_t>(mach_time(kLatest_ns));
    policy.preemptible = TRUE;
    return thread_policy_set(pthread_mach_thread_np(pthread_self()), THREAD_TIME_CONSTRAINT_POLICY,
                             reinterpret_cast<thread_policy_t>(&policy),
                             THREAD_TIME_CONSTRAINT_POLICY_COUNT) == KERN_SUCCESS;
}

void name_thread(const char *name) noexcept {
    pthread_setname_np(name);
}

} // namespace spidar

#endif
