// Calibration without instruments: the grip is moved and turned freely by hand, and the one
// redundant length of eight strings on seven degrees of freedom gives one equation a pose,
//   nu . (measured - computed lengths) = 0,   nu: LengthJacobian::null_vector(),
// for what is wrong with the strings (offsets, gains, winding) and with the frame and pole sizes.
//
// Staged outward from where the counts were zeroed: offsets from the most central poses, then the
// gains over more of them, then everything over all. Each stage is Gauss-Newton with outliers and
// near-singular poses left out. What the poses cannot tell stays near its starting value, by the
// priors, and is named in the result. Allocates: not for the servo loop.
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
    LengthCorrections corrections; // self-calibration reads the pulley, and fits the winding
};

// The size that is known to be true: without one, all lengths could be scaled alike and nothing
// would show. none: the scales are known instead, from fit_string_scale(); set gain_prior to what
// they are worth (0.002). Better where the strings leave over pulleys, as their exits are then not
// quite where the frame's corners are.
enum class TrueSize : std::uint8_t { frame_x, frame_y, frame_z, pole, none };

struct SelfCalibrationSettings {
    bool fit_gains = false;   // one relative scale a string
    bool fit_winding = false; // one curvature a string; needs fit_gains
    bool fit_sizes = false;   // frame sizes along x, y, z and the pole half length; needs fit_gains
    TrueSize true_size = TrueSize::frame_x;
    // What the start is worth (standard deviations). Generous: they hold only what the poses leave
    // open.
    double offset_prior_m = 0.02;
    double gain_prior = 0.05;
    double winding_prior_1_m = 0.1;
    double size_prior = 0.02; // relative
    // Share of the poses, the least travelled first, for the first and the second stage.
    double central_share = 0.3;
    double middle_share = 0.6;
    // Poses whose smallest singular value is lower hold amplified noise (research: 0.3-0.7 mm
    // outliers below 0.25).
    double min_singular = 0.25;
    // Equations further out than this many robust standard deviations (1.4826 MAD) are left out.
    double outlier_sigmas = 5.0;
};

// Order of the unknowns; those not fitted keep value and error 0.
inline constexpr std::size_t kOffsetUnknowns = 0;
inline constexpr std::size_t kGainUnknowns = 8;
inline constexpr std::size_t kWindingUnknowns = 16;
inline constexpr std::size_t kSizeUnknowns = 24; // frame x, y, z, pole
inline constexpr std::size_t kCalibrationUnknowns = 28;
using CalibrationVector = std::array<double, kCalibrationUnknowns>;

// A combination of unknowns, each in units of its prior.
struct WeakCombination {
    double left_open = 0.0; // expected error over prior: 1 = nothing learnt
    CalibrationVector coefficients{};
};

struct SelfCalibrationResult {
    // ok; weakly_observed (usable; see `weak`); negative: `model` is the start, unchanged.
    Status status = Status::too_few_samples;
    DeviceModel model;
    CalibrationVector change{};         // from the start: m, relative, 1/m, relative
    CalibrationVector expected_error{}; // standard errors of the same
    double offset_error_rms_m = 0.0;    // expected, rms over the eight offsets
    double grip_error_rms_m =
        0.0; // expected error of the grip centre over the poses used, from the calibration
    double parity_rms_m = 0.0; // of the equations used: noise and what the model leaves out
    // Singular values of the fitted part, each unknown in units of its prior and the noise as unit:
    // expected error of a combination / prior = 1 / value. Descending.
    std::vector<double> singular;
    std::vector<WeakCombination> weak; // left open by more than a tenth of its prior
    int used = 0;
    int rejected_singular = 0;
    int rejected_outliers = 0;
    int rejected_unsolved = 0; // no pose has these lengths
    int iterations = 0;
};

// start: nominal sizes and scales, offsets from zero_at_pose() (or, for offsets alone, to 5 mm).
[[nodiscard]] SelfCalibrationResult self_calibrate(const DeviceModel &start,
                                                   const std::vector<CountArray> &samples,
                                                   const SelfCalibrationSettings &settings);

// Empty when usable; else one sentence naming field, value, unit and remedy.
[[nodiscard]] std::string validate(const SelfCalibrationSettings &settings);
// "offset of string 3", "gain of string 1", "frame size along z".
[[nodiscard]] std::string unknown_name(std::size_t unknown);
// "left open to 45 % of what was assumed: + offset of string 1 - gain of string 1 ..."; the largest
// parts.
[[nodiscard]] std::string describe(const WeakCombination &combination);

} // namespace spidar
