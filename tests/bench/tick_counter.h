// The processor's own counter, for calls of some hundred nanoseconds: what reading it costs is taken off.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace spidar::bench {

#if defined(__x86_64__)
inline std::uint64_t ticks() {
    __builtin_ia32_lfence();
    const std::uint64_t now = __builtin_ia32_rdtsc();
    __builtin_ia32_lfence();
    return now;
}
#else
inline std::uint64_t ticks() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}
#endif

// Measured once a process.
inline double ns_per_tick() {
    static const double measured = [] {
        const auto start = std::chrono::steady_clock::now();
        const std::uint64_t from = ticks();
        while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(50)) {
        }
        const std::uint64_t to = ticks();
        const std::chrono::duration<double, std::nano> passed =
            std::chrono::steady_clock::now() - start;
        return passed.count() / static_cast<double>(to - from);
    }();
    return measured;
}

// What two reads of the counter cost themselves.
inline std::uint64_t empty_call_ticks() {
    static const std::uint64_t measured = [] {
        std::uint64_t least = ~std::uint64_t{0};
        for (int i = 0; i < 1000; ++i) {
            const std::uint64_t from = ticks();
            least = std::min(least, ticks() - from);
        }
        return least;
    }();
    return measured;
}

} // namespace spidar::bench
