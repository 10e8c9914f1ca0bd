// Histogram of a loop's times in 64 logarithmic buckets, two per octave, 1 ns to 4 s. Written by
// the servo thread, read by any other at any time; relaxed atomics only.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>

namespace spidar {

class LoopHistogram {
public:
    static constexpr int kBuckets = 64;

    void add(std::int64_t time_ns) noexcept {
        const std::uint64_t t = time_ns > 0 ? static_cast<std::uint64_t>(time_ns) : 0;
        buckets_[static_cast<std::size_t>(bucket_of(t))].fetch_add(1, std::memory_order_relaxed);
        if (t > max_ns_.load(std::memory_order_relaxed)) {
            max_ns_.store(t, std::memory_order_relaxed); // single writer: no race
        }
    }

    void clear() noexcept {
        for (auto &bucket : buckets_) {
            bucket.store(0, std::memory_order_relaxed);
        }
        max_ns_.store(0, std::memory_order_relaxed);
    }

    [[nodiscard]] std::uint64_t total() const noexcept {
        std::uint64_t all = 0;
        for (const auto &bucket : buckets_) {
            all += bucket.load(std::memory_order_relaxed);
        }
        return all;
    }

    // Returns the time (unit: us) below which this part (0..1) of all samples lies, within a factor
    // of 2^(1/4), since the middle of its bucket stands for it. Never above max_us(); 0 without
    // samples.
    [[nodiscard]] double quantile_us(double part) const noexcept {
        const std::uint64_t all = total();
        if (all == 0) {
            return 0.0;
        }
        const double wanted = std::clamp(part, 0.0, 1.0) * static_cast<double>(all);
        double sum = 0.0;
        int index = kBuckets - 1;
        for (int i = 0; i < kBuckets; ++i) {
            sum += buckets_[static_cast<std::size_t>(i)].load(std::memory_order_relaxed);
            if (sum >= wanted && sum > 0.0) {
                index = i;
                break;
            }
        }
        return std::min(std::exp2(0.5 * index + 0.25) * 1e-3, max_us());
    }

    // Number of samples in each bucket.
    [[nodiscard]] std::array<std::uint32_t, kBuckets> counts() const noexcept {
        std::array<std::uint32_t, kBuckets> counts{};
        std::copy(buckets_.begin(), buckets_.end(), counts.begin());
        return counts;
    }
    // Lower limit of a bucket (unit: us).
    [[nodiscard]] static double begin_us(int bucket) noexcept {
        return bucket > 0 ? std::exp2(0.5 * bucket) * 1e-3 : 0.0;
    }

    [[nodiscard]] double max_us() const noexcept {
        return static_cast<double>(max_ns_.load(std::memory_order_relaxed)) * 1e-3;
    }

    // Returns floor(2 log2 t), limited to 0..63.
    [[nodiscard]] static int bucket_of(std::uint64_t time_ns) noexcept {
        if (time_ns < 2) {
            return 0;
        }
        const int octave = static_cast<int>(std::bit_width(time_ns)) - 1;
        if (octave >= kBuckets / 2) {
            return kBuckets - 1;
        }
        // The upper half of the octave has t^2 >= 2^(2 octave + 1). t < 2^32, so that t^2 fits.
        const bool upper = time_ns * time_ns >= (std::uint64_t{1} << (2 * octave + 1));
        return 2 * octave + (upper ? 1 : 0);
    }

private:
    std::array<std::atomic<std::uint32_t>, kBuckets> buckets_{};
    std::atomic<std::uint64_t> max_ns_{0};
};

} // namespace spidar
