#include <doctest/doctest.h>

#include <cstdint>
#include <limits>

#include "device/tracking/sample_guard.h"

using namespace spidar;
using Verdict = SampleGuard::Verdict;

namespace {

constexpr double kTick_s = 0.001;

SampleGuard make_guard() {
    StringCalibration strings;
    strings.scale_m_per_count.fill(-kPaperMetresPerCount); // the winding direction must not matter
    SampleGuard guard;
    guard.configure(strings, 5.0, 3, kTick_s);
    return guard;
}

} // namespace

TEST_CASE("sample guard: 5 m/s is 198 counts a millisecond: 198 pass, 199 do not") {
    SampleGuard guard = make_guard();
    CountArray counts{};
    CHECK(guard.check(counts, kTick_s) == Verdict::good);
    CHECK(guard.check(counts, kTick_s) == Verdict::unchanged);
    counts[5] = 198;
    CHECK(guard.check(counts, kTick_s) == Verdict::good);
    counts[5] = 198 - 199;
    CHECK(guard.check(counts, kTick_s) == Verdict::bad);
    CHECK(guard.bad_string() == 5);
    counts[5] = 198;
    CHECK(guard.check(counts, kTick_s) == Verdict::unchanged);
}

TEST_CASE("sample guard: one jump is held, three in a row latch until reset") {
    SampleGuard guard = make_guard();
    CountArray counts{};
    guard.check(counts, kTick_s);
    CountArray jumped = counts;
    jumped[2] = 1000;
    for (int round = 0; round < 5; ++round) { // apart: never latched
        CHECK(guard.check(jumped, kTick_s) == Verdict::bad);
        CHECK(guard.check(jumped, kTick_s) == Verdict::bad);
        CHECK(guard.check(counts, kTick_s) == Verdict::unchanged);
    }
    guard.check(jumped, kTick_s);
    guard.check(jumped, kTick_s);
    CHECK(guard.check(jumped, kTick_s) == Verdict::jumped);
    CHECK(guard.bad_string() == 2);
    CHECK(guard.check(counts, kTick_s) ==
          Verdict::jumped); // the zero may be lost: no way back by itself
    guard.reset();
    CHECK(guard.check(jumped, kTick_s) == Verdict::good);
}

TEST_CASE("sample guard: counts wrap at 32 bits in both directions") {
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
    SampleGuard guard = make_guard();
    CountArray counts{};
    counts.fill(kMost - 10);
    guard.check(counts, kTick_s);
    counts.fill(kLeast + 10);
    CHECK(guard.check(counts, kTick_s) == Verdict::good);
    counts.fill(kMost - 10);
    CHECK(guard.check(counts, kTick_s) == Verdict::good);
    counts.fill(0);
    CHECK(guard.check(counts, kTick_s) == Verdict::bad);
}

TEST_CASE("sample guard: after lost reports the string may have moved further") {
    SampleGuard guard = make_guard();
    CountArray counts{};
    guard.check(counts, kTick_s);
    counts[0] = 600; // 15 mm
    guard.advance_without_reading(kTick_s);
    guard.advance_without_reading(kTick_s);
    guard.advance_without_reading(kTick_s);
    CHECK(guard.check(counts, kTick_s) == Verdict::good);
}
