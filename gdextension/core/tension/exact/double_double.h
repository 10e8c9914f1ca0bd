// A number held as an unevaluated sum of two doubles (about 32 digits), for the few gradients whose
// rounding in double would show in newtons. Uses Dekker (1971) and Knuth's two-sum, without
// hardware FMA, which the plain x86-64 build lacks. Needs -ffp-contract=off and no fast-math.
#pragma once

namespace spidar {

struct DoubleDouble {
    double high = 0.0;
    double low = 0.0;

    [[nodiscard]] double rounded() const noexcept { return high + low; }
};

[[nodiscard]] inline DoubleDouble two_sum(double a, double b) noexcept {
    const double sum = a + b;
    const double b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// Returns the exact product for |a|, |b| below about 1e290.
[[nodiscard]] inline DoubleDouble two_product(double a, double b) noexcept {
    constexpr double kSplitter = 134217729.0; // 2^27 + 1
    const double product = a * b;
    const double a_big = kSplitter * a;
    const double a_high = a_big - (a_big - a);
    const double a_low = a - a_high;
    const double b_big = kSplitter * b;
    const double b_high = b_big - (b_big - b);
    const double b_low = b - b_high;
    return {product,
            ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

[[nodiscard]] inline DoubleDouble operator+(const DoubleDouble &a, const DoubleDouble &b) noexcept {
    const DoubleDouble high = two_sum(a.high, b.high);
    const DoubleDouble low = two_sum(a.low, b.low);
    const DoubleDouble first = two_sum(high.high, high.low + low.high);
    return two_sum(first.high, first.low + low.low);
}

[[nodiscard]] inline DoubleDouble operator*(const DoubleDouble &a, double b) noexcept {
    const DoubleDouble high = two_product(a.high, b);
    return two_sum(high.high, high.low + a.low * b);
}

} // namespace spidar
