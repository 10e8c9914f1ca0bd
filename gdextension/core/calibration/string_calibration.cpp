#include "core/calibration/string_calibration.h"

#include <cmath>
#include <numbers>

#include "core/base/describe_value.h"
#include "core/geometry/frame_geometry.h"

namespace spidar {

namespace {

// Limits of the scale: encoders give 1 um to 1 mm of string per count; a meter or a picometer is a
// unit error.
constexpr double kMinScale_m = 1e-9;
constexpr double kMaxScale_m = 1e-2;
constexpr double kMaxOffset_m = 2.0 * kMaxFrameExtent_m;

// Returns count - zero modulo 2^32 as a signed number. Unsigned subtraction wraps by definition,
// and the conversion is two's complement since C++20.
std::int32_t wrapped_difference(std::int32_t count, std::int32_t zero) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(count) -
                                     static_cast<std::uint32_t>(zero));
}

} // namespace

StringArray lengths_from_counts(const StringCalibration &calibration,
                                const CountArray &counts) noexcept {
    StringArray lengths{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double moved = wrapped_difference(counts[i], calibration.zero_count[i]);
        lengths[i] = calibration.offset_m[i] + calibration.scale_m_per_count[i] * moved;
    }
    return lengths;
}

double metres_per_count(std::uint32_t counts_per_turn, double drum_radius_m,
                        double otherwise) noexcept {
    return counts_per_turn == 0 ? otherwise
                                : 2.0 * std::numbers::pi * drum_radius_m / counts_per_turn;
}

StringCalibration calibrate_at_home(const StringArray &home_lengths_m,
                                    const CountArray &home_counts,
                                    double scale_m_per_count) noexcept {
    StringCalibration calibration;
    calibration.offset_m = home_lengths_m;
    calibration.scale_m_per_count.fill(scale_m_per_count);
    calibration.zero_count = home_counts;
    return calibration;
}

std::string validate(const StringCalibration &calibration) {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double offset = calibration.offset_m[i];
        if (!(std::fabs(offset) <= kMaxOffset_m)) {
            return range_sentence(
                element_name("offset_m", i), offset, "m",
                "give the string length at the zero count, a finite number, or calibrate at home "
                "again.");
        }
        const double scale = calibration.scale_m_per_count[i];
        const double size = std::fabs(scale);
        if (!(size >= kMinScale_m) || !(size <= kMaxScale_m)) {
            return range_sentence(element_name("scale_m_per_count", i), scale, "m/count",
                                  "give the string length per count, " +
                                      with_unit(kMinScale_m, "m/count") + " to " +
                                      with_unit(kMaxScale_m, "m/count") +
                                      " (paper: " + with_unit(kPaperMetresPerCount, "m/count") +
                                      "), negative if wound the other way.");
        }
    }
    return {};
}

} // namespace spidar
