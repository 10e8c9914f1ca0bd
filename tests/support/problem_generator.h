// Random tension problems of every kind that the reference data have and more, each from one seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>

#include "core/tension/tension_solver.h"

namespace spidar::test {

// std::uniform_real_distribution differs between libraries; a seed must replay everywhere.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ULL + 1U) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
    }
    int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    bool chance(double share) { return uniform(0.0, 1.0) < share; }

private:
    std::mt19937_64 engine_;
};

inline Vec3 random_direction(Random &random) {
    const double z = random.uniform(-1.0, 1.0);
    const double turn = random.uniform(0.0, 6.283185307179586);
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

// Two half poles that cross at psi, in any orientation.
inline GripPose random_pose(Random &random, double reach_m, double psi_rad) {
    const double d = kPaperPoleHalfLength_m;
    GripPose pose;
    for (int axis = 0; axis < 3; ++axis) {
        pose.position_m[axis] = random.uniform(-reach_m, reach_m);
    }
    const Vec3 a = random_direction(random);
    Vec3 b = random_direction(random);
    b -= a * (a.x * b.x + a.y * b.y + a.z * b.z);
    b /= std::sqrt(b.x * b.x + b.y * b.y + b.z * b.z);
    pose.r1_m = a * d;
    pose.r2_m = (a * std::cos(psi_rad) + b * std::sin(psi_rad)) * d;
    return pose;
}

struct NamedProblem {
    std::string kind;
    TensionProblem problem;
};

inline constexpr const char *kProblemKinds[] = {
    "central",   "wide",       "far",    "strong",          "zero", "near_parallel", "aligned",
    "rank_lost", "degenerate", "broken", "rank_lost_broken"};

inline NamedProblem random_problem(std::uint64_t seed) {
    Random random(seed);
    constexpr int kKinds = static_cast<int>(std::size(kProblemKinds));
    NamedProblem result;
    result.kind = kProblemKinds[random.below(kKinds)];
    const std::string &kind = result.kind;
    const bool broken = kind.find("broken") != std::string::npos;
    const bool rank_lost = kind.find("rank_lost") != std::string::npos;
    TensionProblem &p = result.problem;

    const double reach = kind == "central" ? 0.1 : kind == "far" ? 0.5 : 0.2;
    double psi = random.uniform(0.5, 2.6);
    if (kind == "near_parallel") {
        psi = std::pow(10.0, random.uniform(-5.0, -0.8));
        psi = random.chance(0.5) ? psi : 3.141592653589793 - psi;
    }
    GripPose pose = random_pose(random, reach, psi);
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    const GripGeometry grip;
    if (kind == "central") {
        const double near = 0.2; // radians of tilt, roughly
        const Vec3 tilt = random_direction(random) * (near * kPaperPoleHalfLength_m);
        pose.r1_m = Vec3(0.0, kPaperPoleHalfLength_m, 0.0) + tilt;
        pose.r2_m = Vec3(kPaperPoleHalfLength_m, 0.0, 0.0) - tilt * 0.5;
    }
    if (kind == "aligned" || rank_lost) {
        pose.r1_m = Vec3(0.0, kPaperPoleHalfLength_m, 0.0);
        pose.r2_m = Vec3(kPaperPoleHalfLength_m, 0.0, 0.0);
        for (int axis = 0; axis < 3; ++axis) {
            pose.position_m[axis] *= random.chance(0.5) ? 0.0 : 1.0;
        }
    }
    if (rank_lost) { // a quarter turn about z, or parallel poles
        if (random.chance(0.7)) {
            pose.r1_m = Vec3(-kPaperPoleHalfLength_m, 0.0, 0.0);
            pose.r2_m = Vec3(0.0, kPaperPoleHalfLength_m, 0.0);
        } else {
            pose.r2_m = pose.r1_m;
        }
    }
    p.matrix = wrench_matrix(frame, grip, pose);

    const double size =
        kind == "strong" ? std::pow(10.0, random.uniform(1.0, 2.3)) : random.uniform(0.0, 6.0);
    for (std::size_t k = 0; k < p.wrench.size(); ++k) {
        const bool off = kind == "zero" || random.chance(0.2);
        p.wrench[k] = off ? 0.0 : random.uniform(-size, size) * (k < 3 ? 1.0 : 0.04);
    }
    const double moment_weight = random.chance(0.8) ? 25.0 : random.uniform(1.0, 40.0);
    p.weights = {1.0, 1.0, 1.0, moment_weight, moment_weight, moment_weight, moment_weight};

    const double exponents[] = {-1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -8.0, -9.0, -10.0, -12.0};
    p.proximal_weight = std::pow(10.0, exponents[random.below(10)]);
    const double lower = random.chance(0.4) ? 0.0 : random.uniform(0.05, 1.0);
    const double upper = random.chance(0.5) ? 10.0 : random.uniform(1.5, 20.0);
    const double target = random.chance(0.3) ? lower : random.uniform(lower, upper);
    for (std::size_t i = 0; i < p.lower_n.size(); ++i) {
        p.lower_n[i] = lower;
        p.upper_n[i] = upper;
        p.proximal_target_n[i] = random.chance(0.2) ? random.uniform(lower, upper) : target;
    }
    if (kind == "degenerate") { // the optimum lies on bounds whose multipliers are zero
        StringArray tensions{};
        for (std::size_t i = 0; i < tensions.size(); ++i) {
            const int place = random.below(3);
            tensions[i] = place == 0 ? lower : place == 1 ? upper : random.uniform(lower, upper);
        }
        p.wrench = spidar::apply(p.matrix, tensions);
        p.proximal_target_n = tensions;
    }
    if (broken) {
        for (int count = 1 + random.below(3); count > 0; --count) {
            const auto i = static_cast<std::size_t>(random.below(kStringCount));
            p.lower_n[i] = 0.0;
            p.upper_n[i] = 0.0;
            p.proximal_target_n[i] = 0.0;
        }
    }
    return result;
}

} // namespace spidar::test
