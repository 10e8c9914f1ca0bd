// Encoder counts -> string lengths: length = offset + scale * (count - zero_count), per string.
#pragma once

#include <string>

#include <cstdint>

#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

// 2 pi * 8 mm pulley / 2000 counts a turn (paper, section VI.1).
inline constexpr double kPaperMetresPerCount = 2.513274122871834e-5;

struct StringCalibration {
    // Length at the zero count (unit: m). Paper frame at the home pose: every string 0.3886... m; see
    // calibrate_at_home(). A negative scale is a motor wound the other way.
    StringArray offset_m{};
    StringArray scale_m_per_count{};
    CountArray zero_count{};
};

// Signed difference count - zero with int32 wrap-around, so a device that wraps reads on.
[[nodiscard]] StringArray lengths_from_counts(const StringCalibration &calibration,
                                              const CountArray &counts) noexcept;

// The calibration that reads `home_lengths_m` at `home_counts`, with one scale for all strings.
[[nodiscard]] StringCalibration calibrate_at_home(const StringArray &home_lengths_m,
                                                  const CountArray &home_counts,
                                                  double scale_m_per_count) noexcept;

// Of an encoder on a drum of this radius; `otherwise` where the device does not say its counts a turn (0).
[[nodiscard]] double metres_per_count(std::uint32_t counts_per_turn, double drum_radius_m,
                                      double otherwise) noexcept;

// Empty when usable; else one sentence naming the field, the value, the unit and the remedy.
[[nodiscard]] std::string validate(const StringCalibration &calibration);

} // namespace spidar
