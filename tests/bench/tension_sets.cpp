#include "bench/tension_sets.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "bench/bench_report.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/geometry/wrench_matrix.h"
#include "support/problem_generator.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kRows = 100000;
constexpr std::size_t kHardRows = kRows / 5;
constexpr double kDegree = 0.017453292519943295;
constexpr double kTinyWeight = 1e-12;

Mat3 turn_about(const Vec3 &direction, double angle_rad) {
    const Vec3 u = direction / std::sqrt(glm::dot(direction, direction));
    const auto rotated = [&](const Vec3 &v) {
        return v * std::cos(angle_rad) + glm::cross(u, v) * std::sin(angle_rad) +
               u * (glm::dot(u, v) * (1.0 - std::cos(angle_rad)));
    };
    return {rotated(Vec3(1, 0, 0)), rotated(Vec3(0, 1, 0)), rotated(Vec3(0, 0, 1))};
}

WrenchMatrix matrix_at(const Vec3 &position, const Mat3 &rotation, double psi_rad) {
    static const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    static const GripGeometry grip;
    const double quarter = 0.5 * 1.5707963267948966;
    const double d = kPaperPoleHalfLength_m;
    GripPose pose;
    pose.position_m = position;
    pose.r1_m = d * (std::cos(quarter + 0.5 * psi_rad) * rotation[0] +
                     std::sin(quarter + 0.5 * psi_rad) * rotation[1]);
    pose.r2_m = d * (std::cos(quarter - 0.5 * psi_rad) * rotation[0] +
                     std::sin(quarter - 0.5 * psi_rad) * rotation[1]);
    return wrench_matrix(frame, grip, pose);
}

TensionProblem standard(const WrenchMatrix &matrix, const PaperWrench &wrench) {
    TensionProblem problem;
    problem.matrix = matrix;
    problem.wrench = wrench;
    problem.weights = {1, 1, 1, 25, 25, 25, 25};
    problem.proximal_weight = 1e-6;
    problem.proximal_target_n.fill(1.0);
    problem.lower_n.fill(0.3);
    problem.upper_n.fill(10.0);
    return problem;
}

WrenchMatrix random_matrix(test::Random &random, double reach_m, double turn_rad, double psi_low,
                           double psi_high) {
    Vec3 position(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        position[axis] = random.uniform(-reach_m, reach_m);
    }
    const Vec3 axis = test::random_direction(random);
    return matrix_at(position, turn_about(axis, random.uniform(0.0, turn_rad)),
                     random.uniform(psi_low, psi_high));
}

PaperWrench wrench_of(const WrenchMatrix &matrix, test::Random &random, double low_n,
                      double high_n) {
    StringArray tensions{};
    for (double &tension : tensions) {
        tension = random.uniform(low_n, high_n);
    }
    return apply(matrix, tensions);
}

double normal(test::Random &random) {
    return std::sqrt(-2.0 * std::log(random.uniform(1e-300, 1.0))) *
           std::cos(6.283185307179586 * random.uniform(0.0, 1.0));
}

TensionProblem random_feasible(test::Random &random) {
    const WrenchMatrix matrix =
        random_matrix(random, 0.2, 45 * kDegree, 30 * kDegree, 120 * kDegree);
    return standard(matrix, wrench_of(matrix, random, 0.3, 10.0));
}

TensionProblem on_trajectory(double t) {
    const Vec3 p(0.11 * std::sin(2.1 * t) + 0.05 * std::sin(7.3 * t + 1),
                 0.10 * std::sin(1.7 * t + 2) + 0.05 * std::sin(6.1 * t),
                 0.09 * std::sin(2.6 * t + 0.5) + 0.06 * std::sin(5.2 * t + 3));
    const Vec3 axis(std::sin(0.7 * t), std::cos(0.9 * t), 0.5 + std::sin(0.31 * t));
    const double psi_deg = 65.0 + 25.0 * std::sin(2.9 * t);
    PaperWrench q{};
    if (p.y < -0.03) {
        const double push = std::fmin(700.0 * (-0.03 - p.y), 8.0);
        q[1] = push;
        q[0] -= 0.3 * push * std::cos(2.1 * t);
        q[2] -= 0.3 * push * std::cos(2.6 * t);
        q[1] += 0.4 * std::sin(1131.0 * t);
    }
    if (p.x > 0.08) {
        q[0] -= std::fmin(700.0 * (p.x - 0.08), 8.0);
    }
    q[3] = 0.04 * std::sin(3.0 * t);
    q[4] = 0.05 * std::sin(2.3 * t);
    q[5] = 0.04 * std::cos(1.9 * t);
    q[6] = psi_deg < 60.0 ? 0.15 * (60.0 - psi_deg) * kDegree : 0.0;
    return standard(
        matrix_at(p, turn_about(axis, 40 * kDegree * std::sin(1.9 * t)), psi_deg * kDegree), q);
}

TensionProblem saturated(test::Random &random, std::size_t row) {
    const bool far = row % 2 == 0;
    const WrenchMatrix matrix =
        far ? random_matrix(random, 0.45, 180 * kDegree, 15 * kDegree, 165 * kDegree)
            : random_matrix(random, 0.2, 45 * kDegree, 30 * kDegree, 120 * kDegree);
    PaperWrench q = wrench_of(matrix, random, -30.0, 100.0);
    if (row % 3 == 0) {
        for (std::size_t k = 0; k < q.size(); ++k) {
            q[k] = normal(random) * (k < 3 ? 80.0 : 3.2);
        }
    }
    return standard(matrix, q);
}

TensionProblem rank_deficient(test::Random &random, std::size_t row) {
    const Mat3 upright(1.0);
    Vec3 position(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        position[axis] = random.uniform(-0.2, 0.2);
    }
    WrenchMatrix matrix = matrix_at(position, upright, 90 * kDegree);
    switch (row % 5) {
    case 0:
        matrix = matrix_at(position, upright, 0.0);
        break;
    case 1:
        matrix = matrix_at(position, upright, 180 * kDegree);
        break;
    case 2:
        matrix.columns[1] = matrix.columns[0];
        break;
    case 3: // no lever arm: forces only
        for (PaperWrench &column : matrix.columns) {
            for (std::size_t k = 3; k < column.size(); ++k) {
                column[k] = 0.0;
            }
        }
        break;
    default:
        matrix = matrix_at(Vec3(0.0), turn_about(Vec3(1, 0, 0), 90 * kDegree), 90 * kDegree);
    }
    const bool feasible = (row / 5) % 2 == 0;
    return standard(matrix, feasible ? wrench_of(matrix, random, 0.3, 10.0)
                                     : wrench_of(matrix, random, -30.0, 40.0));
}

template <class Make>
TensionSet set_of(const char *name, std::size_t rows, const Make &make) {
    TensionSet set;
    set.name = name;
    for (std::size_t i = 0; i < limited(rows); ++i) {
        set.problems.push_back(make(i));
    }
    return set;
}

TensionProblem with_tiny_weight(TensionProblem problem) {
    problem.proximal_weight = kTinyWeight;
    return problem;
}

constexpr std::uint64_t kSetSeed = 20240611;

TensionSet trajectory_set(std::size_t rows) {
    TensionSet set = set_of(
        "S2", rows, [](std::size_t i) { return on_trajectory(1e-3 * static_cast<double>(i)); });
    set.smooth = true;
    return set;
}

// As TensionSolver makes it: ridge, pretension and change from the last tick.
TensionSet at_shipped_settings(const TensionSet &trajectory) {
    const TensionSettings s;
    TensionSet set = trajectory;
    set.name = "S2 shipped";
    const double steady = s.ridge + s.reference_weight;
    const double steady_target = s.reference_weight * s.reference_tension_n / steady;
    StringArray last{};
    last.fill(s.reference_tension_n);
    for (TensionProblem &p : set.problems) {
        p.proximal_weight = steady + s.change_weight;
        p.lower_n.fill(s.min_tension_n);
        p.upper_n.fill(s.max_tension_n);
        for (std::size_t i = 0; i < last.size(); ++i) {
            p.proximal_target_n[i] =
                (steady * steady_target + s.change_weight * last[i]) / p.proximal_weight;
        }
        last = solve_exactly(p, nullptr).tensions_n;
    }
    return set;
}

} // namespace

TensionSet shipped_trajectory_set(std::size_t problems) {
    return at_shipped_settings(trajectory_set(problems));
}

TensionSet feasible_set(std::size_t problems) {
    test::Random random(kSetSeed); // S1 is the first to draw
    return set_of("S1", problems, [&](std::size_t) { return random_feasible(random); });
}

std::vector<TensionSet> tension_sets() {
    test::Random random(kSetSeed);
    std::vector<TensionSet> sets;
    TensionSet trajectory = trajectory_set(kRows);
    sets.push_back(at_shipped_settings(trajectory));
    sets.push_back(std::move(trajectory));
    sets.push_back(set_of("S1", kRows, [&](std::size_t) { return random_feasible(random); }));
    sets.push_back(set_of("S3", kRows, [&](std::size_t i) { return saturated(random, i); }));
    sets.push_back(
        set_of("S4a", kHardRows, [&](std::size_t i) { return rank_deficient(random, i); }));
    sets.push_back(set_of("S4b", kHardRows, [&](std::size_t i) {
        TensionProblem p = random_feasible(random);
        p.wrench = {};
        p.lower_n = {};
        p.proximal_target_n.fill(i % 2 == 0 ? 0.0 : 1.0);
        return p;
    }));
    sets.push_back(set_of("S4c", kHardRows, [&](std::size_t i) {
        TensionProblem p = with_tiny_weight(random_feasible(random));
        if (i % 2 == 1) {
            p.wrench = wrench_of(p.matrix, random, -3.0, 14.0);
        }
        return p;
    }));
    sets.push_back(set_of("S4d", kHardRows, [&](std::size_t i) {
        TensionProblem p = random_feasible(random);
        for (std::size_t n = 0; n <= i % 3; ++n) {
            const auto string = static_cast<std::size_t>(random.below(kStringCount));
            const double held = random.chance(0.5) ? 0.0 : 0.3;
            p.lower_n[string] = held;
            p.upper_n[string] = held;
        }
        return p;
    }));
    sets.push_back(set_of("S4e", kHardRows, [&](std::size_t i) {
        return with_tiny_weight(rank_deficient(random, i));
    }));
    return sets;
}

} // namespace spidar::bench
