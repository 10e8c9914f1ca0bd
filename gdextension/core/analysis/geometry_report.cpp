#include "core/analysis/geometry_report.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/analysis/wrench_closure.h"
#include "core/geometry/pose_tangents.h"
#include "core/geometry/wrench_matrix.h"
#include "core/tension/tension_solver.h"

namespace spidar {

namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kTurn_rad = 30.0 * kDegree;
// Largest tension of the closure test, whose smallest is 1. Beyond it one string would idle while
// another is at its limit.
constexpr double kTensionRange = 1000.0;
// Largest net wrench per newton of tension that counts as zero (rounding and the ridge).
constexpr double kNoWrench = 1e-6;
constexpr double kRidge = 1e-12;
constexpr double kLostPivot = 1e-9; // share of the largest pivot below which a direction is lost
constexpr double kSamePlace_m = 1e-6;
constexpr double kLowShare = 0.5; // share of closed poses below which the report complains

constexpr const char *kMotions[] = {"motion along x",   "motion along y",   "motion along z",
                                    "the turn about x", "the turn about y", "the turn about z",
                                    "the grasp"};

// Messages number strings from 1.
std::string number(std::size_t string) {
    return std::to_string(string + 1);
}

TensionProblem problem_of(const WrenchMatrix &matrix, const GripGeometry &grip) noexcept {
    TensionProblem problem;
    problem.matrix = matrix;
    const double per_d = 1.0 / grip.pole_half_length_m;
    const double grasp = grip.kind == GripKind::rigid ? 0.0 : per_d;
    problem.weights = {1.0, 1.0, 1.0, per_d, per_d, per_d, grasp};
    problem.proximal_weight = kRidge;
    return problem;
}

// Rank of the weighted matrix by elimination with complete pivoting.
int rank_of(const TensionProblem &problem) noexcept {
    std::array<StringArray, kDofCount> m{};
    double largest = 0.0;
    for (std::size_t k = 0; k < m.size(); ++k) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            m[k][i] = problem.weights[k] * problem.matrix.columns[i][k];
            largest = std::max(largest, std::fabs(m[k][i]));
        }
    }
    int rank = 0;
    std::array<bool, kStringCount> used{};
    for (std::size_t step = 0; step < m.size(); ++step) {
        std::size_t row = step;
        std::size_t column = 0;
        double pivot = 0.0;
        for (std::size_t k = step; k < m.size(); ++k) {
            for (std::size_t i = 0; i < kStringCount; ++i) {
                if (!used[i] && std::fabs(m[k][i]) > std::fabs(pivot)) {
                    row = k;
                    column = i;
                    pivot = m[k][i];
                }
            }
        }
        if (!(std::fabs(pivot) > kLostPivot * largest)) {
            break;
        }
        std::swap(m[step], m[row]);
        used[column] = true;
        ++rank;
        for (std::size_t k = step + 1; k < m.size(); ++k) {
            const double factor = m[k][column] / pivot;
            for (std::size_t i = 0; i < kStringCount; ++i) {
                m[k][i] -= factor * m[step][i];
            }
        }
    }
    return rank;
}

// Returns W (A tau - q).
PaperWrench weighted_error(const TensionProblem &problem, const StringArray &tensions) noexcept {
    PaperWrench error = apply(problem.matrix, tensions);
    for (std::size_t k = 0; k < error.size(); ++k) {
        error[k] = problem.weights[k] * (error[k] - problem.wrench[k]);
    }
    return error;
}

// Returns the smallest capacity of three degrees of freedom over both signs.
double capacity_of_three(const WrenchMatrix &matrix, const TensionSettings &settings,
                         std::size_t first) noexcept {
    double least = HUGE_VAL;
    for (std::size_t k = first; k < first + 3; ++k) {
        for (const double sign : {1.0, -1.0}) {
            PaperWrench wrench{};
            wrench[k] = sign;
            const FeasibleScale scale = feasible_scale(matrix, wrench, settings);
            // The feasible wrenches are convex: where zero wrench is not feasible, the grip cannot
            // be held.
            least = std::min(least, scale.any && scale.least == 0.0 ? scale.largest : 0.0);
        }
    }
    return least;
}

void complain_about_places(const FrameGeometry &frame, const GripGeometry &grip,
                           std::vector<std::string> &complaints) {
    const GripPose rest = rest_pose(grip);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (std::size_t j = i + 1; j < kStringCount; ++j) {
            const bool motors = glm::distance(frame.motors_m[i], frame.motors_m[j]) < kSamePlace_m;
            const bool ties = glm::distance(attachment_lever(grip, rest, i),
                                            attachment_lever(grip, rest, j)) < kSamePlace_m;
            if (motors) {
                complaints.push_back(
                    "Motors " + number(i) + " and " + number(j) +
                    (ties ? " and their joints are in one place, so the two strings pull "
                            "alike; move one of them."
                          : " are in one place; move one of them."));
            }
        }
    }
}

// Suggests the exchange of two motors that closes the strings best: a likely error in the numbering
// or in an axis.
void complain_about_exchange(const FrameGeometry &frame, const GripGeometry &grip,
                             std::vector<std::string> &complaints) {
    double best = 0.0;
    std::string remedy;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (std::size_t j = i + 1; j < kStringCount; ++j) {
            FrameGeometry other = frame;
            std::swap(other.motors_m[i], other.motors_m[j]);
            const PoseStatics statics = pose_statics(other, grip, rest_pose(grip));
            if (statics.closed && statics.margin > best) {
                best = statics.margin;
                remedy = "With motors " + number(i) + " and " + number(j) +
                         " exchanged, the strings would hold the grip; check whether the two are "
                         "exchanged.";
            }
        }
    }
    if (!remedy.empty()) {
        complaints.push_back(remedy);
    }
}

std::string unopposed_sentence(const PaperWrench &unopposed) {
    std::size_t most = 0;
    for (std::size_t k = 1; k < unopposed.size(); ++k) {
        most = std::fabs(unopposed[k]) > std::fabs(unopposed[most]) ? k : most;
    }
    return "At rest the strings cannot hold the grip: no string opposes " +
           std::string(kMotions[most]) + " (sign " + (unopposed[most] > 0.0 ? "+" : "-") +
           "); move motors or joints so that some string does.";
}

} // namespace

PoseStatics pose_statics(const FrameGeometry &frame, const GripGeometry &grip,
                         const GripPose &pose) noexcept {
    TensionProblem problem = problem_of(wrench_matrix(frame, grip, pose), grip);
    PoseStatics statics;
    statics.rank = rank_of(problem);
    problem.lower_n.fill(1.0);
    problem.upper_n.fill(kTensionRange);
    problem.proximal_target_n.fill(1.0);
    const StringArray tensions = solve_tension_problem(problem, nullptr).tensions_n;
    const PaperWrench left = weighted_error(problem, tensions);
    const double size = norm(left.values);
    const int full = grip.kind == GripKind::rigid ? 6 : kDofCount;
    const double most = *std::max_element(tensions.begin(), tensions.end());
    // At the optimum no string can reduce the remaining wrench.
    if (size > kNoWrench * most) {
        for (std::size_t k = 0; k < left.size(); ++k) {
            statics.unopposed[k] = left[k] / size;
        }
    } else if (statics.rank == full) {
        statics.closed = true;
        statics.margin = *std::min_element(tensions.begin(), tensions.end()) / most;
    }
    return statics;
}

GeometryReport report_geometry(const FrameGeometry &frame, const GripGeometry &grip,
                               double min_tension_n, double max_tension_n, int poses) {
    GeometryReport report;
    report.degrees_of_freedom = grip.kind == GripKind::rigid ? 6 : kDofCount;
    const GripPose rest = rest_pose(grip);
    report.at_rest = pose_statics(frame, grip, rest);
    complain_about_places(frame, grip, report.complaints);
    if (report.at_rest.rank < report.degrees_of_freedom) {
        report.complaints.push_back(
            "At rest the strings control only " + std::to_string(report.at_rest.rank) + " of the " +
            std::to_string(report.degrees_of_freedom) +
            " degrees of freedom; move the motors or the joints farther apart.");
    } else if (!report.at_rest.closed) {
        report.complaints.push_back(unopposed_sentence(report.at_rest.unopposed));
        complain_about_exchange(frame, grip, report.complaints);
    }

    const MotorBox box = box_around_motors(frame);
    const Vec3 middle = 0.5 * (box.low_m + box.high_m);
    const Vec3 reach = 0.125 * (box.high_m - box.low_m);
    std::mt19937_64 engine(1);
    const auto draw = [&engine](double size) {
        return size * (static_cast<double>(engine() >> 11) * 0x1p-52 - 1.0);
    };
    int closed = 0;
    for (int i = 0; i < poses; ++i) {
        const Vec3 position = middle + Vec3(draw(reach.x), draw(reach.y), draw(reach.z));
        const double x = draw(kTurn_rad);
        const double y = draw(kTurn_rad);
        const double z = draw(kTurn_rad);
        const glm::dquat turn = glm::angleAxis(z, Vec3(0, 0, 1)) *
                                glm::angleAxis(y, Vec3(0, 1, 0)) * glm::angleAxis(x, Vec3(1, 0, 0));
        const GripPose pose = make_pose(grip, position, glm::mat3_cast(turn), 0.0);
        closed += pose_statics(frame, grip, pose).closed ? 1 : 0;
    }
    report.poses = poses;
    report.closure_share = poses > 0 ? static_cast<double>(closed) / poses : 0.0;
    if (report.at_rest.closed && poses > 0 && report.closure_share < kLowShare) {
        report.complaints.push_back(
            "The strings hold the grip in only " +
            std::to_string(std::lround(100.0 * report.closure_share)) +
            " % of the poses around the center; check the positions of motors and joints.");
    }

    TensionSettings settings;
    settings.min_tension_n = min_tension_n;
    settings.max_tension_n = max_tension_n;
    settings.weight_moment_per_m = 1.0 / grip.pole_half_length_m;
    settings.weight_grasp_per_m = settings.weight_moment_per_m;
    settings.dof_mask = grip.kind == GripKind::rigid ? kNoGrasp : kAllDofs;
    const WrenchMatrix matrix = wrench_matrix(frame, grip, rest);
    report.force_capacity_n = capacity_of_three(matrix, settings, 0);
    report.moment_capacity_nm = capacity_of_three(matrix, settings, 3);
    return report;
}

} // namespace spidar
