#include "core/calibration/fit/parity_equation.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

// Returns the length paid out since the zero count, before winding: the root near 0 of m + c m^2 =
// length - offset.
double paid_out(const DeviceModel &model, std::size_t i, double length_m) noexcept {
    const double wound = length_m - model.strings.offset_m[i];
    const double curvature = model.corrections.winding_curvature_1_m[i];
    const double root = std::sqrt(std::fmax(1.0 + 4.0 * curvature * wound, 0.0));
    return 2.0 * wound / (1.0 + root);
}

} // namespace

DeviceModel changed_model(const DeviceModel &start, const CalibrationVector &change) noexcept {
    DeviceModel model = start;
    const Vec3 sizes(1.0 + change[kSizeUnknowns], 1.0 + change[kSizeUnknowns + 1],
                     1.0 + change[kSizeUnknowns + 2]);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        model.strings.offset_m[i] += change[kOffsetUnknowns + i];
        model.strings.scale_m_per_count[i] *= 1.0 + change[kGainUnknowns + i];
        model.corrections.winding_curvature_1_m[i] += change[kWindingUnknowns + i];
        model.frame.motors_m[i] *= sizes;
    }
    model.grip.pole_half_length_m *= 1.0 + change[kSizeUnknowns + 3];
    return model;
}

StringArray length_change(const DeviceModel &model, const LengthJacobian &jacobian,
                          const GripPose &pose, const StringArray &lengths_m,
                          std::size_t unknown) noexcept {
    StringArray change{};
    const std::size_t string = unknown % kStringCount;
    if (unknown < kGainUnknowns) {
        change[string] = 1.0;
    } else if (unknown < kWindingUnknowns) {
        const double m = paid_out(model, string, lengths_m[string]);
        change[string] = m + 2.0 * model.corrections.winding_curvature_1_m[string] * m * m;
    } else if (unknown < kSizeUnknowns) {
        const double m = paid_out(model, string, lengths_m[string]);
        change[string] = m * m;
    } else {
        // The computed length |P0 + s r - Q| grows with -Q along the axis, and with s r.
        const std::size_t size = unknown - kSizeUnknowns;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const Vec3 &e = jacobian.directions()[i];
            const Attachment &tie = model.grip.attachments[i];
            if (size < 3) {
                const auto axis = static_cast<int>(size);
                change[i] = e[axis] * model.frame.motors_m[i][axis];
            } else {
                change[i] = -tie.sign * glm::dot(e, tie.pole == 0 ? pose.r1_m : pose.r2_m);
            }
        }
    }
    return change;
}

CalibrationVector parity_row(const DeviceModel &model, const LengthJacobian &jacobian,
                             const GripPose &pose, const StringArray &lengths_m) noexcept {
    CalibrationVector row{};
    for (std::size_t unknown = 0; unknown < kCalibrationUnknowns; ++unknown) {
        const StringArray change = length_change(model, jacobian, pose, lengths_m, unknown);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            row[unknown] += jacobian.null_vector()[i] * change[i];
        }
    }
    return row;
}

} // namespace spidar
