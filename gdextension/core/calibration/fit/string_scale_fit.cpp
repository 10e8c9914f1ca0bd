#include "core/calibration/fit/string_scale_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "core/calibration/fit/dense_least_squares.h"

namespace spidar {

namespace {

bool counts_differ(const std::vector<CountLengthPair> &pairs) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const CountLengthPair &pair) {
        return pair.count != pairs.front().count;
    });
}

// Adds the pooled spread of the counts of equal lengths about their means, in counts.
void pool_spread(const std::vector<CountLengthPair> &pairs, StringScaleFit &fit) {
    std::map<double, std::vector<double>> trials;
    for (const CountLengthPair &pair : pairs) {
        trials[pair.length_m].push_back(pair.count);
    }
    double square = 0.0;
    double freedom = 0.0;
    for (const auto &[length, counts] : trials) {
        if (counts.size() < 2) {
            continue;
        }
        const auto size = static_cast<double>(counts.size());
        double mean = 0.0;
        for (const double count : counts) {
            mean += count / size;
        }
        for (const double count : counts) {
            square += (count - mean) * (count - mean);
        }
        freedom += size - 1.0;
        ++fit.repeated_points;
    }
    if (freedom > 0.0) {
        fit.repeat_spread_m = std::sqrt(square / freedom) * std::fabs(fit.scale_m_per_count);
    }
}

} // namespace

StringScaleFit fit_string_scale(const std::vector<CountLengthPair> &pairs) {
    StringScaleFit fit;
    for (const CountLengthPair &pair : pairs) {
        if (!std::isfinite(pair.length_m)) {
            fit.status = Status::not_finite;
            return fit;
        }
    }
    if (pairs.empty() || !counts_differ(pairs)) {
        return fit;
    }
    // Counts are centered and scaled by their range, so that both columns have the same size.
    const auto [least, most] = std::minmax_element(
        pairs.begin(), pairs.end(),
        [](const CountLengthPair &a, const CountLengthPair &b) { return a.count < b.count; });
    const double middle = 0.5 * (static_cast<double>(least->count) + most->count);
    const double range = static_cast<double>(most->count) - least->count;
    DenseMatrix a(2);
    std::vector<double> b;
    for (const CountLengthPair &pair : pairs) {
        a.append({1.0, (pair.count - middle) / range});
        b.push_back(pair.length_m);
    }
    const LeastSquaresSolution line = solve_least_squares(a, b, 0.0);
    if (!usable(line.status)) {
        fit.status = line.status;
        return fit;
    }
    fit.status = Status::ok;
    fit.scale_m_per_count = line.x[1] / range;
    fit.offset_m = line.x[0] - fit.scale_m_per_count * middle;
    double square = 0.0;
    for (const CountLengthPair &pair : pairs) {
        const double error = pair.length_m - (fit.offset_m + fit.scale_m_per_count * pair.count);
        square += error * error;
        fit.residual_max_m = std::fmax(fit.residual_max_m, std::fabs(error));
    }
    const auto count = static_cast<double>(pairs.size());
    fit.residual_rms_m = std::sqrt(square / count);
    if (pairs.size() > 2) {
        const double variance = square / (count - 2.0);
        fit.scale_error_m_per_count = std::sqrt(variance * inverse_normal(line)(1, 1)) / range;
    }
    pool_spread(pairs, fit);
    return fit;
}

} // namespace spidar
