// Times of many calls, read as median, p99, p99.9 and maximum.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace spidar::bench {

class SampleTimes {
public:
    explicit SampleTimes(std::size_t capacity) { samples_ns_.reserve(capacity); }

    template <typename Call>
    void time(Call &&call) {
        const auto start = std::chrono::steady_clock::now();
        call();
        const auto stop = std::chrono::steady_clock::now();
        samples_ns_.push_back(std::chrono::duration<double, std::nano>(stop - start).count());
        sorted_ = false;
    }

    // share: 0.5 is the median, 1.0 the maximum.
    [[nodiscard]] double quantile_ns(double share) {
        if (samples_ns_.empty()) {
            return 0.0;
        }
        if (!sorted_) {
            std::sort(samples_ns_.begin(), samples_ns_.end());
            sorted_ = true;
        }
        const auto last = static_cast<double>(samples_ns_.size() - 1);
        return samples_ns_[static_cast<std::size_t>(share * last + 0.5)];
    }

private:
    std::vector<double> samples_ns_;
    bool sorted_ = false;
};

} // namespace spidar::bench
