// System services of the servo thread: clock, deadlines, priority, flushing of denormals.
#pragma once

#include <cstdint>

namespace spidar {

// Monotonic clock (unit: ns).
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

// Returns at or after deadline_ns (monotonic_ns()). The delays of repeated calls with absolute
// deadlines do not add up.
void sleep_until_ns(std::int64_t deadline_ns) noexcept;

// Requests exact timers and real-time priority for the calling thread. Returns true when priority
// was granted. Without priority the loop still runs, less punctually.
bool request_real_time() noexcept;

// Names the calling thread for `top -H` and debuggers. At most 15 letters. Linux and Windows only.
void name_thread(const char *name) noexcept;

// While an object of this class lives, denormal numbers count as zero in this thread (x86-64 and
// arm64). They would cost up to a hundred times the time and carry no information here. Used around
// every servo cycle, threaded or stepped, so that both compute the same bits.
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
