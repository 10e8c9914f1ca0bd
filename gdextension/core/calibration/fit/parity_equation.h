// How each unknown of self-calibration enters the one redundant equation of a pose. Used by
// self_calibration.cpp.
#pragma once

#include "core/calibration/fit/length_jacobian.h"
#include "core/calibration/fit/self_calibration.h"

namespace spidar {

// Returns `start` changed by offsets (m), relative gains, windings (1/m) and relative sizes.
[[nodiscard]] DeviceModel changed_model(const DeviceModel &start,
                                        const CalibrationVector &change) noexcept;

// Returns d(measured - computed lengths)/d(unknown) with the grip held still at lengths_m.
[[nodiscard]] StringArray length_change(const DeviceModel &model, const LengthJacobian &jacobian,
                                        const GripPose &pose, const StringArray &lengths_m,
                                        std::size_t unknown) noexcept;

// Returns nu . length_change() for every unknown.
[[nodiscard]] CalibrationVector parity_row(const DeviceModel &model, const LengthJacobian &jacobian,
                                           const GripPose &pose,
                                           const StringArray &lengths_m) noexcept;

} // namespace spidar
