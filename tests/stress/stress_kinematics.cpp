// stress_kinematics --cases N --seed S: random poses of many kinds, solved cold and warm. Two defining equations:
// exact lengths must be reproduced to rounding (and the pose with them); with length errors the residual must
// be orthogonal to every motion of the grip. Prints the worst case so that it replays; exit code 1 on a failure.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/forward_kinematics.h"

namespace {

using namespace spidar;

constexpr double kDegree = 0.017453292519943295;
// Rounding of eight lengths of up to 0.9 m, with a factor of ten.
constexpr double kLengthTolerance_m = 2e-15;
// The bar of the reference data, with the square root of the smallest pivot in the place of sigma7.
constexpr double kPoseFloor_m = 1e-14;
constexpr double kPoseOverPivot_m = 2e-14;
// Forces of the residuals (in metres) must balance to rounding of residuals times eight strings.
constexpr double kBalanceTolerance_m = 2e-14;

enum class Kind { nominal, wide, near_parallel, z_face, outside_xy, noisy, garbage, count };
constexpr const char *kKindNames[] = {"nominal",    "wide",  "near_parallel", "z_face",
                                      "outside_xy", "noisy", "garbage"};
constexpr int kKindCount = static_cast<int>(Kind::count);

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        // By hand: std::uniform_real_distribution differs from library to library.
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double normal() { // sum of 12 uniforms: enough for noise, the same everywhere
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += between(0.0, 1.0);
        }
        return sum;
    }

private:
    std::mt19937_64 engine_;
};

GripPose random_pose(Random &random, Kind kind, const GripGeometry &grip) {
    const bool wide = kind == Kind::wide;
    const double tilt = (wide ? 60.0 : 30.0) * kDegree;
    double crossing = 90.0 + random.between(-1.0, 1.0) * (wide ? 45.0 : 30.0);
    Vec3 position(random.between(-0.2, 0.2), random.between(-0.2, 0.2), random.between(-0.2, 0.2));
    if (kind == Kind::near_parallel) {
        const double off = std::exp(random.between(std::log(0.1), std::log(10.0)));
        crossing = random.between(0.0, 1.0) < 0.5 ? off : 180.0 - off;
    } else if (kind == Kind::z_face) {
        position.z = std::copysign(random.between(0.2, 0.2399), random.between(-1.0, 1.0));
    } else if (kind == Kind::outside_xy) {
        const int axis = random.between(0.0, 1.0) < 0.5 ? 0 : 1;
        position[axis] = std::copysign(random.between(0.25, 0.36), random.between(-1.0, 1.0));
    }
    const glm::dquat rotation = glm::angleAxis(random.between(-tilt, tilt), Vec3(0, 0, 1)) *
                                glm::angleAxis(random.between(-tilt, tilt), Vec3(0, 1, 0)) *
                                glm::angleAxis(random.between(-tilt, tilt), Vec3(1, 0, 0));
    return make_pose(grip, position, glm::mat3_cast(rotation), (90.0 - crossing) * kDegree);
}

double pose_error(const GripPose &a, const GripPose &b) {
    return std::fmax(glm::distance(a.position_m, b.position_m),
                     std::fmax(glm::distance(a.r1_m, b.r1_m), glm::distance(a.r2_m, b.r2_m)));
}

bool finite_on_spheres(const GripPose &pose, double d) {
    return std::isfinite(glm::dot(pose.position_m, pose.position_m)) &&
           std::fabs(glm::length(pose.r1_m) - d) < 1e-15 &&
           std::fabs(glm::length(pose.r2_m) - d) < 1e-15;
}

// Largest of: sum of residual forces, and the part of their sum on each pole that could turn it.
double imbalance(const FrameGeometry &frame, const GripGeometry &grip, const GripPose &pose,
                 const StringArray &lengths_m) {
    Vec3 force(0.0);
    Vec3 couples[2] = {Vec3(0.0), Vec3(0.0)};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 string = attachment_point(grip, pose, static_cast<int>(i)) - frame.motors_m[i];
        const double length = glm::length(string);
        const Vec3 pull = string * ((lengths_m[i] - length) / length);
        force += pull;
        couples[grip.attachments[i].pole] += pull * grip.attachments[i].sign;
    }
    const double d = grip.pole_half_length_m;
    return std::fmax(glm::length(force),
                     std::fmax(glm::length(glm::cross(pose.r1_m / d, couples[0])),
                               glm::length(glm::cross(pose.r2_m / d, couples[1]))));
}

struct Worst {
    long cases = 0;
    long refused = 0;
    long flagged = 0;
    long failed = 0;
    double value = -1.0; // largest ratio to the tolerance
    long at = -1;
    GripPose pose;
};

struct Verdict {
    double ratio = 0.0;
    Status status = Status::ok;
};

Verdict judge(ForwardKinematics &kinematics, const FrameGeometry &frame, const GripGeometry &grip,
              Random &random, Kind kind, const GripPose &truth) {
    StringArray lengths = string_lengths(frame, grip, truth);
    if (kind == Kind::noisy) {
        const double sigma = std::exp(random.between(std::log(1e-5), std::log(1e-3)));
        for (double &length : lengths) {
            length += sigma * random.normal();
        }
    } else if (kind == Kind::garbage) {
        for (double &length : lengths) {
            length = random.between(0.0, 1.0);
        }
    }
    Verdict verdict;
    const GripPose before = kinematics.last_pose();
    const bool cold = random.between(0.0, 1.0) < 0.5;
    const KinematicsResult result =
        cold ? kinematics.solve_cold(lengths) : kinematics.update(lengths);
    verdict.status = result.status;
    if (!finite_on_spheres(result.pose, grip.pole_half_length_m)) {
        verdict.ratio = HUGE_VAL;
        return verdict;
    }
    if (!usable(result.status)) {
        // A refusal holds the last pose, bit for bit, and is right only where there may be no pose.
        const bool held = pose_error(before, result.pose) == 0.0;
        const bool excused = kind == Kind::garbage || kind == Kind::noisy;
        verdict.ratio = held && excused ? 0.0 : HUGE_VAL;
        return verdict;
    }
    if (kind == Kind::noisy || kind == Kind::garbage) {
        verdict.ratio = imbalance(frame, grip, result.pose, lengths) / kBalanceTolerance_m;
        return verdict;
    }
    const double tolerance = kPoseFloor_m + kPoseOverPivot_m / std::sqrt(result.conditioning);
    verdict.ratio = std::fmax(result.residual_rms_m / kLengthTolerance_m,
                              pose_error(result.pose, truth) / tolerance);
    return verdict;
}

long option(int argc, char **argv, const char *name, long otherwise) {
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], name) == 0) {
            return std::strtol(argv[i + 1], nullptr, 10);
        }
    }
    return otherwise;
}

} // namespace

int main(int argc, char **argv) {
    const long cases = option(argc, argv, "--cases", 20000);
    const long seed = option(argc, argv, "--seed", 1);
    if (cases <= 0) {
        std::fprintf(stderr, "--cases is %ld; give a positive number of cases.\n", cases);
        return 2;
    }
    const GripGeometry grip;
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    ForwardKinematics kinematics;
    if (!usable(kinematics.configure(frame, grip))) {
        return 1;
    }
    Worst worst[kKindCount];
    for (long i = 0; i < cases; ++i) {
        // Each case has its own generator and memory, so that one case replays alone.
        Random random(static_cast<std::uint64_t>(seed) * 1000003ULL +
                      static_cast<std::uint64_t>(i));
        const auto kind = static_cast<Kind>(i % kKindCount);
        const GripPose truth = random_pose(random, kind, grip);
        kinematics.set_last_pose(random_pose(random, Kind::nominal, grip));
        const Verdict verdict = judge(kinematics, frame, grip, random, kind, truth);
        Worst &w = worst[static_cast<int>(kind)];
        ++w.cases;
        w.refused += usable(verdict.status) ? 0 : 1;
        w.flagged += verdict.status == Status::ok ? 0 : 1;
        w.failed += verdict.ratio <= 1.0 ? 0 : 1;
        if (!(verdict.ratio <= w.value)) {
            w.value = verdict.ratio;
            w.at = i;
            w.pose = truth;
        }
    }
    long failed = 0;
    for (int k = 0; k < kKindCount; ++k) {
        const Worst &w = worst[k];
        failed += w.failed;
        std::printf("%-14s cases %ld, refused %ld, flagged %ld, failed %ld, worst ratio %.3g: case "
                    "%ld, P0 %.17g %.17g %.17g, r1 %.17g %.17g %.17g, r2 %.17g %.17g %.17g\n",
                    kKindNames[k], w.cases, w.refused, w.flagged, w.failed, w.value, w.at,
                    w.pose.position_m.x, w.pose.position_m.y, w.pose.position_m.z, w.pose.r1_m.x,
                    w.pose.r1_m.y, w.pose.r1_m.z, w.pose.r2_m.x, w.pose.r2_m.y, w.pose.r2_m.z);
    }
    std::printf("seed %ld, cases %ld, failures %ld\n", seed, cases, failed);
    return failed == 0 ? 0 : 1;
}
