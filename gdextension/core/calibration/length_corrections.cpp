#include "core/calibration/length_corrections.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/describe_value.h"
#include "core/geometry/frame_geometry.h"

namespace spidar {

namespace {

// Largest curvature: the paper's drum changes by 4.6 % over 0.7 m (0.07 1/m); ten times that is not
// a drum.
constexpr double kMaxCurvature_1_m = 0.7;
constexpr double kMaxStiffness_n = 1e9;
constexpr double kMaxPulley_m = 0.05;
constexpr double kUnitTolerance = 1e-6;
constexpr double kMaxTension_n = 1000.0;

bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

} // namespace

StringArray wound_lengths(const StringCalibration &calibration,
                          const LengthCorrections &corrections, const CountArray &counts) noexcept {
    StringArray lengths = lengths_from_counts(calibration, counts);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double paid_out = lengths[i] - calibration.offset_m[i];
        const double bend = corrections.winding_curvature_1_m[i] * paid_out * paid_out;
        lengths[i] += std::isfinite(bend) ? bend : 0.0;
    }
    return lengths;
}

StringArray compensate_stretch(const LengthCorrections &corrections, const StringArray &lengths_m,
                               const StringArray &tensions_n) noexcept {
    StringArray lengths = lengths_m;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double stiffness = corrections.axial_stiffness_n[i];
        const double strain = (tensions_n[i] - corrections.calibration_tension_n[i]) / stiffness;
        if (!(stiffness > 0.0) || !std::isfinite(strain)) {
            continue;
        }
        const double stretched = lengths_m[i] + corrections.hidden_length_m[i];
        const double stretch = std::clamp(strain, -kMaxStrain, kMaxStrain) * stretched;
        lengths[i] += std::isfinite(stretch) ? stretch : 0.0;
    }
    return lengths;
}

std::string validate(const LengthCorrections &corrections) {
    if (!within(corrections.pulley_radius_m, 0.0, kMaxPulley_m)) {
        return range_sentence(
            "pulley_radius_m", corrections.pulley_radius_m, "m",
            "give the radius of the exit pulleys in meters, up to 0.05, or 0 for eyelets.");
    }
    const double axis = glm::length(corrections.swivel_axis);
    if (!within(axis, 1.0 - kUnitTolerance, 1.0 + kUnitTolerance)) {
        return "swivel_axis has length " + with_unit(axis, "m/m") +
               "; give a unit vector, for instance (0, 1, 0).";
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double curvature = corrections.winding_curvature_1_m[i];
        if (!within(curvature, -kMaxCurvature_1_m, kMaxCurvature_1_m)) {
            return range_sentence(element_name("winding_curvature_1_m", i), curvature, "1/m",
                                  "give -0.7 to 0.7 1/m, or 0 if it is not known.");
        }
        const double stiffness = corrections.axial_stiffness_n[i];
        if (!within(stiffness, 0.0, kMaxStiffness_n)) {
            return range_sentence(
                element_name("axial_stiffness_n", i), stiffness, "N",
                "give the string's EA in newtons (a 0.3 mm braid: about 3000 N), or 0 "
                "if it is not known.");
        }
        const double hidden = corrections.hidden_length_m[i];
        if (!within(hidden, 0.0, kMaxFrameExtent_m)) {
            return range_sentence(
                element_name("hidden_length_m", i), hidden, "m",
                "give the length of the string between drum and exit in meters, or 0.");
        }
        const double tension = corrections.calibration_tension_n[i];
        if (!within(tension, 0.0, kMaxTension_n)) {
            return range_sentence(
                element_name("calibration_tension_n", i), tension, "N",
                "give the tension in newtons at which the lengths were calibrated.");
        }
    }
    return {};
}

} // namespace spidar
