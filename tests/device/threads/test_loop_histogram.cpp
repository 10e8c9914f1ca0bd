#include <doctest/doctest.h>

#include <cmath>

#include "device/threads/loop_histogram.h"

using spidar::LoopHistogram;

TEST_CASE("histogram: buckets are half octaves, without gaps or overlaps") {
    int last = 0;
    for (std::uint64_t t = 1; t < 100000; ++t) {
        const int bucket = LoopHistogram::bucket_of(t);
        REQUIRE(bucket >= last);
        REQUIRE(bucket ==
                static_cast<int>(std::floor(2.0 * std::log2(static_cast<double>(t)) + 1e-12)));
        last = bucket;
    }
    CHECK(LoopHistogram::bucket_of(0) == 0);
    CHECK(LoopHistogram::bucket_of(~std::uint64_t{0}) == LoopHistogram::kBuckets - 1);
    CHECK(LoopHistogram::bucket_of((std::uint64_t{1} << 32) - 1) == LoopHistogram::kBuckets - 1);
}

TEST_CASE("histogram: quantiles to a quarter octave, the greatest value exactly") {
    LoopHistogram histogram;
    CHECK(histogram.quantile_us(0.5) == 0.0);
    for (int i = 0; i < 990; ++i) {
        histogram.add(10'000);
    }
    for (int i = 0; i < 10; ++i) {
        histogram.add(5'000'000);
    }
    const double quarter_octave = std::exp2(0.25);
    CHECK(histogram.quantile_us(0.5) <= 10.0 * quarter_octave);
    CHECK(histogram.quantile_us(0.5) >= 10.0 / quarter_octave);
    CHECK(histogram.quantile_us(0.995) <= 5000.0 * quarter_octave);
    CHECK(histogram.quantile_us(0.995) >= 5000.0 / quarter_octave);
    CHECK(histogram.max_us() == 5000.0);
    histogram.add(-5);
    CHECK(histogram.max_us() == 5000.0);
    histogram.clear();
    CHECK(histogram.max_us() == 0.0);
    CHECK(histogram.quantile_us(1.0) == 0.0);
}
