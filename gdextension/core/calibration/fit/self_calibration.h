// Calibration without instruments: the grip is moved and turned freely by hand. Eight strings on
// seven degrees of freedom give one redundant equation per pose,
//   nu . (measured - computed lengths) = 0,   nu: LengthJacobian::null_vector().
// The equations determine errors of strings (offset, gain, winding), frame size and pole size.
//
// The fit runs in stages, outward from where the counts were zeroed: the offsets over the poses
// nearest to the zero; offsets and gains over more poses and then over all; then, over all poses,
// also the sizes, and last also the windings. Each stage takes Gauss-Newton steps and leaves out
// outliers and near-singular poses. Priors keep a combination of unknowns that the poses do not
// determine near its start, and the result names it. Allocates: not for the servo loop.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/calibration/length_corrections.h"
#include "core/calibration/string_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct DeviceModel {
    FrameGeometry frame;
    GripGeometry grip;
    StringCalibration strings;
    LengthCorrections corrections; // self-calibration reads the pulley and fits the winding
};

// The one size that fit_sizes takes as true, since lengths alone do not determine the overall
// scale. With `none` the string scales are known instead, from fit_string_scale(): set gain_prior
// to their accuracy (0.002). `none` is better for pulley exits, which do not lie exactly at the
// frame's corners.
enum class TrueSize : std::uint8_t { frame_x, frame_y, frame_z, pole, none };

struct SelfCalibrationSettings {
    bool fit_gains = false;   // one relative scale per string
    bool fit_winding = false; // one curvature per string; needs fit_gains
    bool fit_sizes = false;   // frame sizes along x, y, z and the pole half length; needs fit_gains
    TrueSize true_size = TrueSize::frame_x;
    // Standard deviations (priors) of the starting values. They are wide, so that they matter only
    // for what the poses do not determine.
    double offset_prior_m = 0.02;
    double gain_prior = 0.05;
    double winding_prior_1_m = 0.1;
    double size_prior = 0.02; // relative
    // Share of the poses used in the first stage; the poses nearest to the zero are taken first.
    double central_share = 0.3;
    // Share of the poses used in the second stage. Must not be below central_share.
    double middle_share = 0.6;
    // Poses with a smaller LengthJacobian::smallest_singular() are left out: they amplify noise
    // (outliers of 0.3-0.7 mm were measured below 0.25).
    double min_singular = 0.25;
    // Equations whose error exceeds this many robust standard deviations (1.4826 times the median
    // of the absolute errors) are left out.
    double outlier_sigmas = 5.0;
};

// First index of each kind in a CalibrationVector. The change and the error of a kind that is not
// fitted are 0.
inline constexpr std::size_t kOffsetUnknowns = 0;
inline constexpr std::size_t kGainUnknowns = 8;
inline constexpr std::size_t kWindingUnknowns = 16;
inline constexpr std::size_t kSizeUnknowns = 24; // frame x, y, z, pole
inline constexpr std::size_t kCalibrationUnknowns = 28;
using CalibrationVector = std::array<double, kCalibrationUnknowns>;

// A combination of unknowns that the poses determine badly; each coefficient is in units of its
// unknown's prior.
struct WeakCombination {
    double left_open = 0.0; // expected error over prior; 1: the poses say nothing about it
    CalibrationVector coefficients{};
};

struct SelfCalibrationResult {
    // ok; weakly_observed: usable, see `weak`; negative: `model` is the unchanged start.
    Status status = Status::too_few_samples;
    DeviceModel model;
    CalibrationVector change{};         // from the start; units: m, relative, 1/m, relative
    CalibrationVector expected_error{}; // standard error of each element of `change`
    double offset_error_rms_m = 0.0;    // expected rms error of the eight offsets
    // Expected rms error of the grip center, caused by the calibration, over some of the poses
    // used.
    double grip_error_rms_m = 0.0;
    // Rms error of the equations used (unit: m): noise, and errors that the model does not cover.
    double parity_rms_m = 0.0;
    // Singular values of the fitted part, descending. Unknowns are in units of their priors and
    // equations in units of the noise, so that 1 / value = expected error of a combination over its
    // prior.
    std::vector<double> singular;
    // Combinations whose left_open exceeds about 0.1.
    std::vector<WeakCombination> weak;
    int used = 0;
    int rejected_singular = 0;
    int rejected_outliers = 0;
    int rejected_unsolved = 0; // poses whose lengths no grip pose has
    int iterations = 0;
};

// start: nominal sizes and scales, and offsets from zero_at_pose(). If only offsets are fitted,
// offsets known to 5 mm suffice. samples: encoder counts of the poses. Returns invalid_geometry for
// a rigid grip, which has two redundant lengths; invalid_settings and invalid_calibration if
// validate() returns a sentence; too_few_samples for fewer usable poses than unknowns;
// not_converged if a step leads to a model that is not valid.
[[nodiscard]] SelfCalibrationResult self_calibrate(const DeviceModel &start,
                                                   const std::vector<CountArray> &samples,
                                                   const SelfCalibrationSettings &settings);

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const SelfCalibrationSettings &settings);
// Returns "offset of string 3", "gain of string 1" or "frame size along z".
[[nodiscard]] std::string unknown_name(std::size_t unknown);
// Returns "known only to 45 % of the assumed error: + offset of string 1 - gain of string 1 ...",
// with the largest parts only.
[[nodiscard]] std::string describe(const WeakCombination &combination);

} // namespace spidar
