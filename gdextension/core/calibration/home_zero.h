// Zeroing at a known pose (home): counts read while the grip rests in its stand, several times
// over. Allocates: not for the servo loop.
#pragma once

#include <vector>

#include "core/base/status.h"
#include "core/calibration/length_corrections.h"
#include "core/calibration/string_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct HomeZero {
    // ok; too_few_samples (no counts); invalid_geometry; invalid_calibration (scale). Negative: the
    // rest is zero.
    Status status = Status::too_few_samples;
    // Reads the home pose's lengths at the middle of the counts (their median: one glitch does no
    // harm).
    StringCalibration strings;
    StringArray spread_m{}; // standard deviation of the repeats about their mean; large: placed
                            // differently each time
};

[[nodiscard]] HomeZero zero_at_pose(const FrameGeometry &frame, const GripGeometry &grip,
                                    const GripPose &home, const std::vector<CountArray> &repeats,
                                    const StringArray &scale_m_per_count,
                                    const LengthCorrections &corrections);

} // namespace spidar
