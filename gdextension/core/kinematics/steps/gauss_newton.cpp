#include "core/kinematics/steps/gauss_newton.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/pose_tangents.h"
#include "core/geometry/string_exit.h"
#include "core/kinematics/steps/rigid_step.h"

namespace spidar {

namespace {

// Normal equations J^T J step = J^T residual. A string affects the position and one pole only, so
// that the two pole blocks are not coupled: [P A B; A' S 0; B' 0 T].
struct ArrowEquations {
    struct PoleBlock {
        double uu = 0.0;
        double uv = 0.0;
        double vv = 0.0;
        Vec3 position_u{0.0}; // coupling columns to the position
        Vec3 position_v{0.0};
        double gradient_u = 0.0;
        double gradient_v = 0.0;
    };
    std::array<double, 6> position{}; // xx xy xz yy yz zz
    Vec3 gradient{0.0};
    std::array<PoleBlock, 2> poles;
};

void add_outer(std::array<double, 6> &m, const Vec3 &a, const Vec3 &b, double factor) noexcept {
    m[0] += factor * a.x * b.x;
    m[1] += factor * a.x * b.y;
    m[2] += factor * a.x * b.z;
    m[3] += factor * a.y * b.y;
    m[4] += factor * a.y * b.z;
    m[5] += factor * a.z * b.z;
}

ArrowEquations arrow_equations(const LengthProblem &problem, const LengthErrors &errors,
                               const PoseTangents &tangents) noexcept {
    ArrowEquations eq;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &attachment = problem.grip.attachments[i];
        const auto pole = static_cast<std::size_t>(attachment.pole);
        const Vec3 &e = errors.direction[i];
        const double f = errors.residual_m[i];
        const double u = attachment.sign * glm::dot(e, tangents.poles[pole].u);
        const double v = attachment.sign * glm::dot(e, tangents.poles[pole].v);
        add_outer(eq.position, e, e, 1.0);
        eq.gradient += f * e;
        ArrowEquations::PoleBlock &block = eq.poles[pole];
        block.uu += u * u;
        block.uv += u * v;
        block.vv += v * v;
        block.position_u += u * e;
        block.position_v += v * e;
        block.gradient_u += f * u;
        block.gradient_v += f * v;
    }
    return eq;
}

void add_expected(ArrowEquations &eq, const GripPose &pose, const PoseTangents &tangents,
                  const ExpectedPose &expected) noexcept {
    const double weight = expected.weight;
    for (const std::size_t diagonal : {0U, 3U, 5U}) {
        eq.position[diagonal] += weight;
    }
    eq.gradient += weight * (expected.pose.position_m - pose.position_m);
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3 off = k == 0 ? expected.pose.r1_m - pose.r1_m : expected.pose.r2_m - pose.r2_m;
        eq.poles[k].uu += weight;
        eq.poles[k].vv += weight;
        eq.poles[k].gradient_u += weight * glm::dot(off, tangents.poles[k].u);
        eq.poles[k].gradient_v += weight * glm::dot(off, tangents.poles[k].v);
    }
}

// Returns pivot / diagonal, or 0 when that is not a positive number.
double scaled_pivot(double pivot, double diagonal) noexcept {
    const double ratio = pivot / diagonal;
    return ratio > 0.0 ? ratio : 0.0;
}

// Block elimination: the poles first, then the 3x3 Schur complement of the position by LDL^T.
struct ArrowSolution {
    PoseStep step{};
    double min_pivot = 0.0;
    bool solvable = false;
};

ArrowSolution solve_arrow(const ArrowEquations &eq) noexcept {
    ArrowSolution solution;
    std::array<double, 6> s = eq.position;
    Vec3 g = eq.gradient;
    double smallest = 1.0;
    std::array<double, 2> ratio{};  // uv / uu
    std::array<double, 2> second{}; // second pivot of the pole block
    std::array<Vec3, 2> column_v{}; // coupling of v after u is eliminated
    std::array<double, 2> gradient_v{};
    for (std::size_t k = 0; k < 2; ++k) {
        const ArrowEquations::PoleBlock &b = eq.poles[k];
        if (!(b.uu > 0.0)) {
            return solution;
        }
        ratio[k] = b.uv / b.uu;
        second[k] = b.vv - ratio[k] * b.uv;
        // The determinant over the squared mean diagonal is, unlike a pivot, the same in every
        // basis.
        const double mean = 0.5 * (b.uu + b.vv);
        smallest = std::fmin(smallest, scaled_pivot(b.uu * second[k], mean * mean));
        if (!(second[k] > 0.0)) {
            return solution;
        }
        column_v[k] = b.position_v - ratio[k] * b.position_u;
        gradient_v[k] = b.gradient_v - ratio[k] * b.gradient_u;
        add_outer(s, b.position_u, b.position_u, -1.0 / b.uu);
        add_outer(s, column_v[k], column_v[k], -1.0 / second[k]);
        g -= b.position_u * (b.gradient_u / b.uu) + column_v[k] * (gradient_v[k] / second[k]);
    }
    const double d0 = s[0];
    const double l10 = s[1] / d0;
    const double l20 = s[2] / d0;
    const double d1 = s[3] - l10 * s[1];
    const double t21 = s[4] - l10 * s[2];
    const double l21 = t21 / d1;
    const double d2 = s[5] - l20 * s[2] - l21 * t21;
    smallest = std::fmin(smallest, scaled_pivot(d0, eq.position[0]));
    smallest = std::fmin(smallest, scaled_pivot(d1, eq.position[3]));
    smallest = std::fmin(smallest, scaled_pivot(d2, eq.position[5]));
    solution.min_pivot = smallest;
    if (!(d0 > 0.0) || !(d1 > 0.0) || !(d2 > 0.0)) {
        return solution;
    }
    const double y1 = g.y - l10 * g.x;
    const double y2 = g.z - l20 * g.x - l21 * y1;
    const double z = y2 / d2;
    const double y = y1 / d1 - l21 * z;
    const double x = g.x / d0 - l10 * y - l20 * z;
    const Vec3 position(x, y, z);
    solution.step = {x, y, z};
    for (std::size_t k = 0; k < 2; ++k) {
        const ArrowEquations::PoleBlock &b = eq.poles[k];
        const double v = (gradient_v[k] - glm::dot(column_v[k], position)) / second[k];
        const double u = (b.gradient_u - glm::dot(b.position_u, position)) / b.uu - ratio[k] * v;
        solution.step[3 + 2 * k] = u;
        solution.step[4 + 2 * k] = v;
    }
    solution.solvable = std::isfinite(norm(solution.step));
    return solution;
}

} // namespace

double LengthErrors::rms_m() const noexcept {
    return std::sqrt(sum_of_squares_m2 / kStringCount);
}

LengthErrors length_errors(const LengthProblem &problem, const GripPose &pose) noexcept {
    LengthErrors errors;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const StringPath path = string_path(
            problem.frame, i, pose.position_m + attachment_lever(problem.grip, pose, i));
        errors.computed_m[i] = path.length_m;
        errors.residual_m[i] = problem.lengths_m[i] - path.length_m;
        errors.direction[i] = path.direction;
        errors.sum_of_squares_m2 += errors.residual_m[i] * errors.residual_m[i];
    }
    return errors;
}

GaussNewtonStep gauss_newton_step(const LengthProblem &problem, const LengthErrors &errors,
                                  GripPose &pose, const ExpectedPose &expected) noexcept {
    GaussNewtonStep step;
    if (problem.grip.kind == GripKind::rigid) {
        const RigidSolution rigid = solve_rigid(problem, errors, pose, expected);
        step.min_pivot = rigid.min_pivot;
        step.solvable = rigid.solvable;
        if (step.solvable) {
            step.step_m = norm(rigid.step);
            move_rigid(pose, rigid.step, problem.grip.pole_half_length_m);
        }
        return step;
    }
    const PoseTangents tangents = tangents_of(pose);
    ArrowEquations equations = arrow_equations(problem, errors, tangents);
    if (expected.weight > 0.0) {
        add_expected(equations, pose, tangents, expected);
    }
    const ArrowSolution solution = solve_arrow(equations);
    step.min_pivot = solution.min_pivot;
    step.solvable = solution.solvable;
    if (step.solvable) {
        step.step_m = norm(solution.step);
        move_pose(pose, tangents, solution.step, problem.grip.pole_half_length_m);
    }
    return step;
}

} // namespace spidar
