#include "core/calibration/fit/self_calibration.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/calibration/exit_pulley.h"
#include "core/calibration/fit/dense_least_squares.h"
#include "core/calibration/fit/length_jacobian.h"
#include "core/calibration/fit/parity_equation.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar {

namespace {

// Gauss-Newton takes 5-10 steps per stage on this mildly curved problem; the limit leaves room for
// bad starts.
constexpr int kMaxStageIterations = 30;
// Step, as a share of a prior, below which a stage has converged (0.02 m * 1e-9: a thousandth of a
// nanometer).
constexpr double kConverged = 1e-9;
// Share of its prior above which a combination counts as weakly observed.
constexpr double kWeak = 0.1;
// Standard deviation of a normal distribution over its median absolute deviation.
constexpr double kMadToSigma = 1.4826;
// Number of poses over which the grip error is averaged: more change nothing in its third digit.
constexpr std::size_t kErrorPoses = 200;
// Smallest noise: exact test data would otherwise make the priors weightless.
constexpr double kNoiseFloor_m = 1e-9;

// Rounds of exit correction. The exit moves by about 1 % of the pose's motion: three rounds reduce
// a start error of ten centimeters to a micrometer.
constexpr int kPulleyRounds = 3;

using Unknowns = std::vector<std::size_t>;

struct Sample {
    const CountArray *counts = nullptr;
    double travel = 0.0; // rms counts from zero
    GripPose pose;       // of the last iteration that used it
    bool trusted = false;
};

struct Stage {
    Unknowns unknowns;
    std::size_t samples = 0;
};

struct System {
    std::vector<CalibrationVector> rows;
    std::vector<double> errors_m;
    std::vector<GripPose> poses;
    double sigma_m = 0.0;
    int singular = 0;
    int outliers = 0;
    int unsolved = 0;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

CalibrationVector priors(const SelfCalibrationSettings &settings) {
    CalibrationVector prior{};
    for (std::size_t k = 0; k < kCalibrationUnknowns; ++k) {
        prior[k] = k < kGainUnknowns      ? settings.offset_prior_m
                   : k < kWindingUnknowns ? settings.gain_prior
                   : k < kSizeUnknowns    ? settings.winding_prior_1_m
                                          : settings.size_prior;
    }
    return prior;
}

std::vector<Stage> stages_of(const SelfCalibrationSettings &settings, std::size_t samples) {
    const auto share = [&](double part) {
        return static_cast<std::size_t>(std::ceil(part * static_cast<double>(samples)));
    };
    Unknowns unknowns(8);
    std::iota(unknowns.begin(), unknowns.end(), kOffsetUnknowns);
    std::vector<Stage> stages{{unknowns, share(settings.central_share)}};
    const auto add = [&](std::size_t first, std::size_t count) {
        for (std::size_t k = first; k < first + count; ++k) {
            if (k != kSizeUnknowns + static_cast<std::size_t>(settings.true_size)) {
                unknowns.push_back(k);
            }
        }
    };
    if (settings.fit_gains) {
        add(kGainUnknowns, 8);
        stages.push_back({unknowns, share(settings.middle_share)});
    }
    stages.push_back({unknowns, samples});
    if (settings.fit_sizes) {
        add(kSizeUnknowns, 4);
        stages.push_back({unknowns, samples});
    }
    if (settings.fit_winding) {
        add(kWindingUnknowns, 8);
        stages.push_back({unknowns, samples});
    }
    return stages;
}

// Returns the straight-line lengths for the exits of this pose.
StringArray straight(const DeviceModel &model, const GripPose &pose, StringArray lengths_m) {
    const StringArray excess = exit_excess(model.frame, model.grip, model.corrections, pose);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        lengths_m[i] -= excess[i];
    }
    return lengths_m;
}

KinematicsResult solve_sample(const DeviceModel &model, ForwardKinematics &kinematics,
                              const Sample &sample, const StringArray &lengths_m) {
    KinematicsResult solved;
    if (sample.trusted) {
        kinematics.set_last_pose(sample.pose);
        solved = kinematics.update(straight(model, sample.pose, lengths_m));
    } else {
        solved = kinematics.solve_cold(straight(model, rest_pose(model.grip), lengths_m));
    }
    if (model.corrections.pulley_radius_m > 0.0) {
        for (int k = 0; k < kPulleyRounds && usable(solved.status); ++k) {
            kinematics.set_last_pose(solved.pose);
            solved = kinematics.update(straight(model, solved.pose, lengths_m));
        }
    }
    return solved;
}

// Returns the equations of a stage at the present model. The samples keep their poses for the next
// call.
System equations(const DeviceModel &model, const SelfCalibrationSettings &settings,
                 std::vector<Sample> &samples, std::size_t count) {
    System system;
    ForwardKinematics kinematics;
    if (!usable(kinematics.configure(model.frame, model.grip))) {
        return system;
    }
    std::vector<std::size_t> from;
    for (std::size_t s = 0; s < count; ++s) {
        Sample &sample = samples[s];
        const StringArray lengths = wound_lengths(model.strings, model.corrections, *sample.counts);
        const KinematicsResult solved = solve_sample(model, kinematics, sample, lengths);
        sample.trusted = false;
        if (!usable(solved.status)) {
            ++system.unsolved;
            continue;
        }
        const LengthJacobian jacobian(model.frame, model.grip, solved.pose);
        if (!(jacobian.smallest_singular() >= settings.min_singular)) {
            ++system.singular;
            continue;
        }
        sample.pose = solved.pose;
        system.rows.push_back(parity_row(model, jacobian, solved.pose, lengths));
        system.errors_m.push_back(jacobian.parity_m(straight(model, solved.pose, lengths)));
        system.poses.push_back(solved.pose);
        from.push_back(s);
    }
    if (system.rows.empty()) {
        return system;
    }
    std::vector<double> sizes;
    sizes.reserve(system.errors_m.size());
    for (const double error : system.errors_m) {
        sizes.push_back(std::fabs(error));
    }
    system.sigma_m = std::fmax(kMadToSigma * median(sizes), kNoiseFloor_m);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < system.rows.size(); ++k) {
        if (!(sizes[k] <= settings.outlier_sigmas * system.sigma_m)) {
            ++system.outliers;
            continue;
        }
        samples[from[k]].trusted = true;
        system.rows[kept] = system.rows[k];
        system.errors_m[kept] = system.errors_m[k];
        system.poses[kept] = system.poses[k];
        ++kept;
    }
    system.rows.resize(kept);
    system.errors_m.resize(kept);
    system.poses.resize(kept);
    return system;
}

// Solves with rows in units of prior and noise. change: adds the priors as one row per unknown;
// null: without priors.
LeastSquaresSolution solve(const System &system, const Unknowns &unknowns,
                           const CalibrationVector &prior, const CalibrationVector *change) {
    DenseMatrix a(unknowns.size());
    std::vector<double> b;
    std::vector<double> row(unknowns.size());
    for (std::size_t k = 0; k < system.rows.size(); ++k) {
        for (std::size_t j = 0; j < unknowns.size(); ++j) {
            row[j] = system.rows[k][unknowns[j]] * prior[unknowns[j]] / system.sigma_m;
        }
        a.append(row);
        b.push_back(-system.errors_m[k] / system.sigma_m);
    }
    if (change != nullptr) {
        for (std::size_t j = 0; j < unknowns.size(); ++j) {
            std::fill(row.begin(), row.end(), 0.0);
            row[j] = 1.0;
            a.append(row);
            b.push_back(-(*change)[unknowns[j]] / prior[unknowns[j]]);
        }
    }
    return solve_least_squares(a, b, 0.0);
}

double rms(const std::vector<double> &values) {
    double square = 0.0;
    for (const double value : values) {
        square += value * value;
    }
    return std::sqrt(square / static_cast<double>(values.size()));
}

// Returns the expected rms error of the grip center over the poses: sqrt(mean(trace(J C J'))), with
// J the derivative of the grip center by the unknowns and C their covariance.
double grip_error(const DeviceModel &model, const System &system, const Unknowns &unknowns,
                  const CalibrationVector &prior, const DenseMatrix &covariance) {
    const std::size_t stride = std::max<std::size_t>(1, system.poses.size() / kErrorPoses);
    double sum = 0.0;
    int poses = 0;
    for (std::size_t k = 0; k < system.poses.size(); k += stride, ++poses) {
        const LengthJacobian jacobian(model.frame, model.grip, system.poses[k]);
        std::vector<PoseStep> motions;
        for (const std::size_t unknown : unknowns) {
            StringArray change =
                length_change(model, jacobian, system.poses[k], jacobian.lengths_m(), unknown);
            for (double &value : change) {
                value *= prior[unknown];
            }
            motions.push_back(jacobian.motion(change));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < unknowns.size(); ++i) {
                for (std::size_t j = 0; j < unknowns.size(); ++j) {
                    sum += motions[i][axis] * covariance(i, j) * motions[j][axis];
                }
            }
        }
    }
    return poses > 0 ? std::sqrt(std::fmax(sum, 0.0) / poses) : 0.0;
}

void report(SelfCalibrationResult &result, const System &system, const Unknowns &unknowns,
            const CalibrationVector &prior) {
    // The observability comes from the poses alone, the covariance from the solution with priors.
    const LeastSquaresSolution data = solve(system, unknowns, prior, nullptr);
    result.singular = data.singular;
    for (std::size_t j = 0; j < data.singular.size(); ++j) {
        if (data.singular[j] * kWeak >= 1.0) {
            continue;
        }
        WeakCombination weak;
        weak.left_open = 1.0 / std::hypot(1.0, data.singular[j]);
        for (std::size_t i = 0; i < unknowns.size(); ++i) {
            weak.coefficients[unknowns[i]] = data.right(i, j);
        }
        result.weak.push_back(weak);
    }
    const DenseMatrix covariance = inverse_normal(solve(system, unknowns, prior, &result.change));
    double offsets = 0.0;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
        const std::size_t unknown = unknowns[j];
        result.expected_error[unknown] = prior[unknown] * std::sqrt(covariance(j, j));
        if (unknown < kGainUnknowns) {
            offsets += result.expected_error[unknown] * result.expected_error[unknown];
        }
    }
    result.offset_error_rms_m = std::sqrt(offsets / kStringCount);
    result.grip_error_rms_m = grip_error(result.model, system, unknowns, prior, covariance);
    result.parity_rms_m = rms(system.errors_m);
    result.used = static_cast<int>(system.rows.size());
    result.rejected_singular = system.singular;
    result.rejected_outliers = system.outliers;
    result.rejected_unsolved = system.unsolved;
    result.status = result.weak.empty() ? Status::ok : Status::weakly_observed;
}

SelfCalibrationResult refusal(const DeviceModel &start, Status status) {
    SelfCalibrationResult result;
    result.status = status;
    result.model = start;
    return result;
}

} // namespace

SelfCalibrationResult self_calibrate(const DeviceModel &start,
                                     const std::vector<CountArray> &samples,
                                     const SelfCalibrationSettings &settings) {
    if (!validate(settings).empty()) {
        return refusal(start, Status::invalid_settings);
    }
    if (!is_usable(start.frame) || !is_usable(start.grip, start.frame) ||
        start.grip.kind != GripKind::crossed) { // one redundant length only
        return refusal(start, Status::invalid_geometry);
    }
    if (!validate(start.strings).empty() || !validate(start.corrections).empty()) {
        return refusal(start, Status::invalid_calibration);
    }
    const CalibrationVector prior = priors(settings);
    std::vector<Sample> ordered;
    ordered.reserve(samples.size());
    for (const CountArray &one : samples) {
        const StringArray lengths = lengths_from_counts(start.strings, one);
        double square = 0.0;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double travel = lengths[i] - start.strings.offset_m[i];
            square += travel * travel;
        }
        ordered.push_back({&one, square, {}, false});
    }
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const Sample &a, const Sample &b) { return a.travel < b.travel; });

    SelfCalibrationResult result;
    result.model = start;
    const std::vector<Stage> stages = stages_of(settings, ordered.size());
    System system;
    for (const Stage &stage : stages) {
        double step = HUGE_VAL;
        for (int i = 0; i < kMaxStageIterations && step > kConverged; ++i, ++result.iterations) {
            system = equations(result.model, settings, ordered, stage.samples);
            if (system.rows.size() < stage.unknowns.size()) {
                SelfCalibrationResult refused = refusal(start, Status::too_few_samples);
                refused.used = static_cast<int>(system.rows.size());
                refused.rejected_singular = system.singular;
                refused.rejected_outliers = system.outliers;
                refused.rejected_unsolved = system.unsolved;
                return refused;
            }
            const LeastSquaresSolution solution =
                solve(system, stage.unknowns, prior, &result.change);
            if (!usable(solution.status)) {
                return refusal(start, solution.status);
            }
            step = 0.0;
            for (std::size_t j = 0; j < stage.unknowns.size(); ++j) {
                // A step above the prior exceeds the range of the linear equations.
                const double part = std::clamp(solution.x[j], -1.0, 1.0);
                result.change[stage.unknowns[j]] += part * prior[stage.unknowns[j]];
                step = std::fmax(step, std::fabs(part));
            }
            result.model = changed_model(start, result.change);
            if (!is_usable(result.model.frame) ||
                !is_usable(result.model.grip, result.model.frame) ||
                !validate(result.model.strings).empty()) {
                return refusal(start, Status::not_converged);
            }
        }
    }
    system = equations(result.model, settings, ordered, ordered.size());
    if (system.rows.size() < stages.back().unknowns.size()) {
        return refusal(start, Status::too_few_samples);
    }
    report(result, system, stages.back().unknowns, prior);
    return result;
}

} // namespace spidar
