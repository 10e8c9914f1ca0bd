// What the servo thread needs from the system: a clock, absolute deadlines, priority, and flushing of denormals.
#pragma once

#include <cstdint>

namespace spidar {

// Monotonic (unit: ns).
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

// Returns at or after this instant of monotonic_ns(). Absolute: delays do not add up.
void sleep_until_ns(std::int64_t deadline_ns) noexcept;

// For the calling thread: timers without slack, and real-time priority where the system grants it (no error
// where it does not: the loop only gets less punctual). True when priority was granted.
bool request_real_time() noexcept;

// What `top -H` and a debugger call the calling thread; at most 15 letters. Linux only.
void name_thread(const char *name) noexcept;

// While it lives, denormal numbers count as zero in this thread: they cost a hundredfold and mean nothing here.
// Used around every servo cycle, threaded or stepped, so that both compute the same bits.
class FlushDenormals {
public:
    FlushDenormals() noexcept;
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals &) = delete;
    FlushDenormals &operator=(const FlushDenormals &) = delete;

private:
    std::uint64_t saved_ = 0;
};

} // namespace spidar
