// How each unknown of self-calibration enters the one redundant equation of a pose. Used by
// self_calibration.cpp.
#pragma once

#include "core/calibration/fit/length_jacobian.h"
#include "core/calibration/fit/self_calibration.h"

namespace spidar {

// Returns `start` with `change` applied. Units of `change`: see SelfCalibrationResult::change.
[[nodiscard]] DeviceModel changed_model(const DeviceModel &start,
                                        const CalibrationVector &change) noexcept;

// Returns d(measured - computed lengths)/d(unknown) at a fixed pose. lengths_m: the measured
// lengths at that pose.
[[nodiscard]] StringArray length_change(const DeviceModel &model, const LengthJacobian &jacobian,
                                        const GripPose &pose, const StringArray &lengths_m,
                                        std::size_t unknown) noexcept;

// Returns nu . length_change() for every unknown.
[[nodiscard]] CalibrationVector parity_row(const DeviceModel &model, const LengthJacobian &jacobian,
                                           const GripPose &pose,
                                           const StringArray &lengths_m) noexcept;

} // namespace spidar
