// Converts encoder counts to lengths: length = offset + scale * (count - zero_count), per string.
#pragma once

#include <string>

#include <cstdint>

#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

// Length per count in the paper (unit: m): 2 pi * 8 mm / 2000 counts per turn (section VI.1).
inline constexpr double kPaperMetresPerCount = 2.513274122871834e-5;

struct StringCalibration {
    // Length at the zero count (unit: m). Paper's device at the home pose: 0.3939... m.
    StringArray offset_m{};
    // Length per count (unit: m). Negative: the count falls as string is paid out.
    StringArray scale_m_per_count{};
    CountArray zero_count{};
};

// Returns lengths (unit: m). count - zero_count wraps modulo 2^32, so that a counter may overflow.
[[nodiscard]] StringArray lengths_from_counts(const StringCalibration &calibration,
                                              const CountArray &counts) noexcept;

// Returns the calibration that gives home_lengths_m at home_counts, with one scale for all strings.
[[nodiscard]] StringCalibration calibrate_at_home(const StringArray &home_lengths_m,
                                                  const CountArray &home_counts,
                                                  double scale_m_per_count) noexcept;

// Returns the length per count of an encoder on a drum of this radius, or `otherwise` when
// counts_per_turn is 0 (not reported by the device).
[[nodiscard]] double metres_per_count(std::uint32_t counts_per_turn, double drum_radius_m,
                                      double otherwise) noexcept;

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const StringCalibration &calibration);

} // namespace spidar
