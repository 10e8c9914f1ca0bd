#include "core/kinematics/search/pose_polish.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/pose_tangents.h"
#include "core/kinematics/steps/rigid_step.h"

namespace spidar {

namespace {

constexpr std::size_t kSize = kDofCount;
using Matrix = std::array<PoseStep, kSize>; // lower triangle used

// Quadratic convergence takes 3-8 steps from the closed form; the limit leaves room for damped
// distant starts.
constexpr int kMaxPolishSteps = 50;
// Damping factors of the descent, relative to the diagonal (Levenberg-Marquardt).
constexpr double kFirstDamping = 1e-3;
constexpr double kDampingRise = 8.0;
constexpr double kDampingFall = 0.1;
// Damping below this is dropped, so that the last steps are undamped.
constexpr double kNoDamping = 1e-8;
// Share of its diagonal below which a pivot is rounding: the matrix counts as not positive
// definite.
constexpr double kSmallestPivot = 1e-15;
// Residual below which the lengths are about to fit exactly. Near a singular pose the curvature
// then exceeds what the lengths determine, and damping would hold the pose on the floor of a
// valley; Gauss-Newton moves along it.
constexpr double kExactResidual_m = 1e-8;

struct NewtonEquations {
    Matrix gauss{};      // J^T J
    Matrix curvature{};  // - sum residual * second derivative of the length
    PoseStep gradient{}; // J^T residual
};

// Motion of an attachment with each of the unknowns that affect it.
template <std::size_t Count>
struct Motions {
    std::array<Vec3, Count> of_attachment{};
    std::array<std::size_t, Count> unknown{};
};

template <std::size_t Count>
void add_string(NewtonEquations &eq, const LengthErrors &errors, std::size_t i,
                const Motions<Count> &motions) noexcept {
    const Vec3 &e = errors.direction[i];
    const double f = errors.residual_m[i];
    std::array<double, Count> slope{};
    for (std::size_t a = 0; a < Count; ++a) {
        slope[a] = glm::dot(e, motions.of_attachment[a]);
    }
    const double per_length = errors.computed_m[i] > 0.0 ? f / errors.computed_m[i] : 0.0;
    for (std::size_t a = 0; a < Count; ++a) {
        const std::size_t row = motions.unknown[a];
        eq.gradient[row] += f * slope[a];
        for (std::size_t b = 0; b <= a; ++b) {
            const std::size_t column = motions.unknown[b];
            eq.gauss[row][column] += slope[a] * slope[b];
            eq.curvature[row][column] -=
                per_length * (glm::dot(motions.of_attachment[a], motions.of_attachment[b]) -
                              slope[a] * slope[b]);
        }
    }
}

NewtonEquations newton_equations(const LengthProblem &problem, const LengthErrors &errors,
                                 const GripPose &pose, const PoseTangents &tangents) noexcept {
    NewtonEquations eq;
    const double d = problem.grip.pole_half_length_m;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &attachment = problem.grip.attachments[i];
        const auto pole = static_cast<std::size_t>(attachment.pole);
        const Tangents &t = tangents.poles[pole];
        const Vec3 &r = pole == 0 ? pose.r1_m : pose.r2_m;
        const Motions<5> motions{{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1),
                                  attachment.sign * t.u, attachment.sign * t.v},
                                 {0, 1, 2, 3 + 2 * pole, 4 + 2 * pole}};
        add_string(eq, errors, i, motions);
        // A displaced pole end returns to its sphere: r loses |displacement|^2 / (2 d^2) of its
        // length.
        const double fall =
            errors.residual_m[i] * attachment.sign * glm::dot(errors.direction[i], r) / (d * d);
        eq.curvature[3 + 2 * pole][3 + 2 * pole] += fall;
        eq.curvature[4 + 2 * pole][4 + 2 * pole] += fall;
    }
    return eq;
}

// Same for a rigid grip: displacement, then the turn times d. The seventh unknown does not move.
NewtonEquations rigid_newton_equations(const LengthProblem &problem, const LengthErrors &errors,
                                       const GripPose &pose) noexcept {
    NewtonEquations eq;
    const double per_d = 1.0 / problem.grip.pole_half_length_m;
    const std::array<Vec3, 3> axes{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 lever = attachment_lever(problem.grip, pose, i);
        Motions<6> motions;
        for (std::size_t a = 0; a < 3; ++a) {
            motions.of_attachment[a] = axes[a];
            motions.of_attachment[3 + a] = per_d * glm::cross(axes[a], lever);
        }
        motions.unknown = {0, 1, 2, 3, 4, 5};
        add_string(eq, errors, i, motions);
        // A turn bends the path of the attachment: 1/2 (a x (b x lever) + b x (a x lever)).
        const Vec3 &e = errors.direction[i];
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b <= a; ++b) {
                const Vec3 bend = glm::cross(axes[a], glm::cross(axes[b], lever)) +
                                  glm::cross(axes[b], glm::cross(axes[a], lever));
                eq.curvature[3 + a][3 + b] -=
                    0.5 * per_d * per_d * errors.residual_m[i] * glm::dot(e, bend);
            }
        }
    }
    eq.gauss[kSize - 1][kSize - 1] = 1.0;
    return eq;
}

// Solves (gauss + use_curvature * curvature + damping * diag(gauss)) step = gradient by Cholesky.
// False when the matrix is not positive definite.
bool solve_damped(const NewtonEquations &eq, bool use_curvature, double damping,
                  PoseStep &step) noexcept {
    Matrix l{};
    for (std::size_t i = 0; i < kSize; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = eq.gauss[i][j] + (use_curvature ? eq.curvature[i][j] : 0.0);
            if (i == j) {
                sum += damping * (eq.gauss[i][i] + 1.0);
            }
            for (std::size_t k = 0; k < j; ++k) {
                sum -= l[i][k] * l[j][k];
            }
            if (i != j) {
                l[i][j] = sum / l[j][j];
            } else if (sum > kSmallestPivot * (eq.gauss[i][i] + damping)) {
                l[i][i] = std::sqrt(sum);
            } else {
                return false;
            }
        }
    }
    for (std::size_t i = 0; i < kSize; ++i) {
        double sum = eq.gradient[i];
        for (std::size_t k = 0; k < i; ++k) {
            sum -= l[i][k] * step[k];
        }
        step[i] = sum / l[i][i];
    }
    for (std::size_t i = kSize; i-- > 0;) {
        double sum = step[i];
        for (std::size_t k = i + 1; k < kSize; ++k) {
            sum -= l[k][i] * step[k];
        }
        step[i] = sum / l[i][i];
    }
    return std::isfinite(norm(step));
}

// Takes a Newton step where the full matrix is positive definite, else a Gauss-Newton step, damped
// unless the lengths fit already.
bool descent_step(const NewtonEquations &eq, double sum_of_squares_m2, double &damping,
                  PoseStep &step) noexcept {
    if (solve_damped(eq, true, damping, step)) {
        return true;
    }
    if (sum_of_squares_m2 < kStringCount * kExactResidual_m * kExactResidual_m &&
        solve_damped(eq, false, damping, step)) {
        return true;
    }
    damping = std::fmax(damping, kFirstDamping);
    return solve_damped(eq, false, damping, step);
}

} // namespace

PolishResult polish_pose(const LengthProblem &problem, const GripPose &start) noexcept {
    PolishResult result;
    result.pose = start;
    LengthErrors errors = length_errors(problem, start);
    const bool rigid = problem.grip.kind == GripKind::rigid;
    double damping = 0.0;
    double last_step_m = HUGE_VAL;
    while (result.steps < kMaxPolishSteps && !result.converged) {
        ++result.steps;
        const PoseTangents tangents = tangents_of(result.pose);
        const NewtonEquations eq = rigid ? rigid_newton_equations(problem, errors, result.pose)
                                         : newton_equations(problem, errors, result.pose, tangents);
        PoseStep step{};
        if (!descent_step(eq, errors.sum_of_squares_m2, damping, step)) {
            break;
        }
        double step_m = norm(step);
        if (step_m > kMaxTrialStep_m) {
            for (double &x : step) {
                x *= kMaxTrialStep_m / step_m;
            }
            step_m = kMaxTrialStep_m;
        }
        GripPose trial = result.pose;
        if (rigid) {
            move_rigid(trial, {step[0], step[1], step[2], step[3], step[4], step[5]},
                       problem.grip.pole_half_length_m);
        } else {
            move_pose(trial, tangents, step, problem.grip.pole_half_length_m);
        }
        const LengthErrors trial_errors = length_errors(problem, trial);
        // Steps this small are below the resolution of the sum of squares: they are taken without
        // comparing it.
        const bool tiny = step_m < kStagnantStep_m;
        if (tiny || trial_errors.sum_of_squares_m2 <= errors.sum_of_squares_m2) {
            result.pose = trial;
            errors = trial_errors;
            damping = damping * kDampingFall < kNoDamping ? 0.0 : damping * kDampingFall;
            result.converged = damping == 0.0 &&
                               (step_m < kConvergedStep_m || (tiny && step_m > 0.5 * last_step_m));
            last_step_m = step_m;
        } else {
            damping = std::fmax(damping * kDampingRise, kFirstDamping);
        }
    }
    result.residual_rms_m = errors.rms_m();
    GripPose unused = result.pose;
    result.min_pivot = gauss_newton_step(problem, errors, unused).min_pivot;
    return result;
}

} // namespace spidar
