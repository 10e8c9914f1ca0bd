#include "core/calibration/home_zero.h"

#include <algorithm>
#include <cmath>

#include "core/calibration/exit_pulley.h"

namespace spidar {

HomeZero zero_at_pose(const FrameGeometry &frame, const GripGeometry &grip, const GripPose &home,
                      const std::vector<CountArray> &repeats, const StringArray &scale_m_per_count,
                      const LengthCorrections &corrections) {
    HomeZero zero;
    if (!is_usable(frame) || !is_usable(grip, frame)) {
        zero.status = Status::invalid_geometry;
        return zero;
    }
    if (repeats.empty()) {
        return zero;
    }
    StringCalibration strings;
    strings.offset_m = string_lengths(frame, grip, home);
    const StringArray excess = exit_excess(frame, grip, corrections, home);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        strings.offset_m[i] += excess[i];
    }
    strings.scale_m_per_count = scale_m_per_count;
    if (!validate(strings).empty() || !validate(corrections).empty()) {
        zero.status = Status::invalid_calibration;
        return zero;
    }
    StringArray spread{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        std::vector<std::int32_t> counts;
        counts.reserve(repeats.size());
        for (const CountArray &repeat : repeats) {
            counts.push_back(repeat[i]);
        }
        const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
        std::nth_element(counts.begin(), middle, counts.end());
        strings.zero_count[i] = *middle;
        // Relative to the median, so that counts near the 32-bit wrap can be averaged
        double mean = 0.0;
        double square = 0.0;
        for (const std::int32_t count : counts) {
            const double off = static_cast<double>(count) - *middle;
            mean += off / static_cast<double>(counts.size());
            square += off * off;
        }
        const auto n = static_cast<double>(counts.size());
        const double variance = n > 1.0 ? (square - n * mean * mean) / (n - 1.0) : 0.0;
        spread[i] = std::sqrt(std::fmax(variance, 0.0)) * std::fabs(scale_m_per_count[i]);
    }
    zero.strings = strings;
    zero.spread_m = spread;
    zero.status = Status::ok;
    return zero;
}

} // namespace spidar
