// Zero of the strings at a known pose (home): counts are read several times while the grip rests in
// its stand. Allocates: not for the servo loop.
#pragma once

#include <vector>

#include "core/base/status.h"
#include "core/calibration/length_corrections.h"
#include "core/calibration/string_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct HomeZero {
    // ok; too_few_samples (no counts); invalid_geometry; invalid_calibration (scale or
    // corrections). Negative: all values below are zero.
    Status status = Status::too_few_samples;
    // Calibration that gives the lengths of the home pose at the median counts. Among three or more
    // readings one wrong reading does no harm.
    StringCalibration strings;
    // Standard deviation of the repeated readings (unit: m). A large value means that the grip was
    // not placed in the same way each time.
    StringArray spread_m{};
};

[[nodiscard]] HomeZero zero_at_pose(const FrameGeometry &frame, const GripGeometry &grip,
                                    const GripPose &home, const std::vector<CountArray> &repeats,
                                    const StringArray &scale_m_per_count,
                                    const LengthCorrections &corrections);

} // namespace spidar
