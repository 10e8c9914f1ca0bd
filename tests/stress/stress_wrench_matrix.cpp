// stress_wrench_matrix --cases N --seed S: the wrench matrix at random and adversarial poses of several devices. Defining
// equations: each pull is a unit vector along its string, the moment its lever's, the whole minus the slope of the
// lengths for a random twist. What is not finite must show, and the tension solver must answer it with a status and
// tensions in bounds. Prints the worst case so that it replays; exit code 1 on a failure.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <glm/geometric.hpp>

#include "core/geometry/string_exit.h"
#include "core/geometry/wrench_matrix.h"
#include "core/presets/presets.h"
#include "core/tension/tension_solver.h"
#include "support/case_random.h"
#include "support/command_line.h"

namespace {

using namespace spidar;
using test::CaseRandom;

constexpr double kDegree = 0.017453292519943295;
// Unit vectors, and levers of up to a metre times them: some roundings.
constexpr double kRounding = 4e-15;
// Central differences over 1e-6 of strings not shorter than a centimetre: h^2 / (6 l^2), and rounding over h.
constexpr double kStep = 1e-6;
constexpr double kSlopeTolerance = 2e-8;
constexpr double kShortString_m = 0.01;

enum class Kind {
    nominal,
    wide,
    near_parallel,
    parallel,
    at_motor,
    far_away,
    tiny,
    garbage,
    count
};
constexpr const char *kKindNames[] = {"nominal",  "wide",     "near_parallel", "parallel",
                                      "at_motor", "far_away", "tiny",          "garbage"};
constexpr int kKindCount = static_cast<int>(Kind::count);

struct Device {
    FrameGeometry frame;
    GripGeometry grip;
};

std::vector<Device> devices() {
    std::vector<Device> list;
    for (int i = 0; i < kPresetCount; ++i) {
        const DevicePreset preset = device_preset(static_cast<Preset>(i));
        list.push_back({preset.frame, preset.grip});
    }
    list.push_back({make_box_frame(Vec3(0.4, 0.25, 0.15)), GripGeometry()});
    list.push_back(list.front());
    list.back().frame.pulley_radius_m = 0.004;
    return list;
}

GripPose pose_of_kind(CaseRandom &random, Kind kind, const Device &device) {
    const GripGeometry &grip = device.grip;
    const bool wide = kind == Kind::wide;
    double grasp = random.between(-1.0, 1.0) * (wide ? 45.0 : 30.0) * kDegree;
    Vec3 position = 0.6 * std::fabs(device.frame.motors_m[0].y) * random.vector(1.0);
    if (kind == Kind::near_parallel) {
        grasp = std::copysign(90.0 * kDegree - random.spread(1e-12, 0.1), grasp);
    } else if (kind == Kind::parallel) {
        grasp = std::copysign(90.0 * kDegree, grasp);
    } else if (kind == Kind::far_away) {
        position *= random.spread(1e2, 1e300);
    } else if (kind == Kind::tiny) {
        position *= random.spread(1e-320, 1e-10);
    }
    if (grip.kind == GripKind::rigid) {
        grasp = 0.0;
    }
    GripPose pose =
        make_pose(grip, position, random.rotation((wide ? 60.0 : 30.0) * kDegree), grasp);
    if (kind == Kind::at_motor) {
        const std::size_t i = random.below(kStringCount);
        pose.position_m = device.frame.motors_m[i] - attachment_lever(grip, pose, i);
        pose.position_m += random.below(2) == 0 ? Vec3(0.0) : 1e-12 * random.vector(1.0);
    } else if (kind == Kind::garbage) {
        for (Vec3 *v : {&pose.position_m, &pose.r1_m, &pose.r2_m}) {
            if (random.below(2) == 0) {
                (*v)[static_cast<int>(random.below(3))] = random.nasty();
            }
        }
    }
    return pose;
}

// The defining equations of one string's column, over their tolerance.
double column_error(const Device &device, const GripPose &pose, std::size_t i,
                    const WrenchMatrix &matrix) {
    const PaperWrench &c = matrix.columns[i];
    const Vec3 pull(c[0], c[1], c[2]);
    const Vec3 moment(c[3], c[4], c[5]);
    const Vec3 lever = attachment_lever(device.grip, pose, i);
    const StringPath path = string_path(device.frame, i, pose.position_m + lever);
    double worst = glm::distance(moment, glm::cross(lever, pull));
    if (path.length_m > kShortString_m) {
        worst = std::fmax(worst, std::fabs(glm::length(pull) - 1.0));
        worst = std::fmax(worst, glm::distance(pull, -path.direction));
    } else {
        const double size = glm::length(pull); // none, or a unit vector
        worst = std::fmax(worst, std::fmin(size, std::fabs(size - 1.0)));
    }
    if (matrix.grasp_row_vanishes) {
        worst = std::fmax(worst, std::fabs(c[6]));
    } else {
        const Vec3 normal = glm::normalize(glm::cross(pose.r1_m, pose.r2_m));
        const double sign = device.grip.attachments[i].pole == 0 ? 1.0 : -1.0;
        worst = std::fmax(worst, std::fabs(c[6] - sign * glm::dot(normal, moment)));
    }
    return worst / kRounding;
}

// Lengths against A^T twist, by central differences.
double slope_error(const Device &device, const GripPose &pose, const WrenchMatrix &matrix,
                   CaseRandom &random) {
    const Vec3 linear = random.vector(1.0);
    const Vec3 angular = random.vector(1.0);
    const bool has_grasp = !matrix.grasp_row_vanishes;
    const double alpha = has_grasp ? random.between(-1.0, 1.0) : 0.0;
    const Vec3 normal = has_grasp ? glm::normalize(glm::cross(pose.r1_m, pose.r2_m)) : Vec3(0.0);
    const auto moved = [&](double t) {
        const auto turned = [](const Vec3 &v, const Vec3 &turn) {
            const double angle = glm::length(turn);
            return angle > 0.0 ? glm::angleAxis(angle, turn / angle) * v : v;
        };
        GripPose next = pose;
        next.position_m += t * linear;
        next.r1_m = turned(turned(pose.r1_m, t * alpha * normal), t * angular);
        next.r2_m = turned(turned(pose.r2_m, -t * alpha * normal), t * angular);
        return string_lengths(device.frame, device.grip, next);
    };
    const StringArray more = moved(kStep);
    const StringArray less = moved(-kStep);
    const StringArray shortening = apply_transposed(
        matrix, {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z, alpha});
    double worst = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (more[i] > kShortString_m) {
            const double slope = (more[i] - less[i]) / (2.0 * kStep);
            worst = std::fmax(worst, std::fabs(slope + shortening[i]) / kSlopeTolerance);
        }
    }
    return worst;
}

// Whatever the matrix holds, the solver's answer has a status and stays in bounds.
double solver_error(const WrenchMatrix &matrix, bool finite) {
    TensionSolver solver;
    const TensionSettings settings;
    if (!usable(solver.configure(settings))) {
        return HUGE_VAL;
    }
    const TensionResult result = solver.update(matrix, {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
    for (const double tension : result.tensions_n) {
        if (!(tension >= 0.0 && tension <= settings.max_tension_n)) {
            return HUGE_VAL;
        }
    }
    return finite || !usable(result.status) ? 0.0 : HUGE_VAL;
}

double judge(const Device &device, CaseRandom &random, Kind kind, const GripPose &pose) {
    const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, pose);
    bool finite = true;
    for (const PaperWrench &column : matrix.columns) {
        for (const double value : column) {
            finite = finite && std::isfinite(value);
        }
    }
    if (kind == Kind::garbage || kind == Kind::far_away) {
        return solver_error(matrix, finite);
    }
    if (!finite) {
        return HUGE_VAL;
    }
    double worst = kind == Kind::at_motor ? solver_error(matrix, true) : 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        worst = std::fmax(worst, column_error(device, pose, i, matrix));
    }
    // Nearer to parallel than a step is long the normal turns within it.
    if (kind == Kind::nominal || kind == Kind::wide) {
        worst = std::fmax(worst, slope_error(device, pose, matrix, random));
    }
    return worst;
}

struct Worst {
    long cases = 0;
    long failed = 0;
    double ratio = -1.0; // to the tolerance
    long at = -1;
};

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 20000);
    const long seed = test::whole_option(argc, argv, "--seed", 1);
    const long first =
        test::whole_option(argc, argv, "--first", 0); // replay: --first CASE --cases 1
    if (cases <= 0 || first < 0) {
        std::fprintf(stderr, "--cases is %ld, --first is %ld; give a positive number of cases.\n",
                     cases, first);
        return 2;
    }
    const std::vector<Device> list = devices();
    Worst worst[kKindCount];
    for (long i = first; i < first + cases; ++i) {
        CaseRandom random(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(i));
        const auto kind = static_cast<Kind>(i % kKindCount);
        const Device &device = list[random.below(list.size())];
        const GripPose pose = pose_of_kind(random, kind, device);
        const double ratio = judge(device, random, kind, pose);
        Worst &w = worst[static_cast<int>(kind)];
        ++w.cases;
        w.failed += ratio <= 1.0 ? 0 : 1;
        if (!(ratio <= w.ratio)) {
            w.ratio = ratio;
            w.at = i;
        }
    }
    long failed = 0;
    for (int k = 0; k < kKindCount; ++k) {
        const Worst &w = worst[k];
        failed += w.failed;
        std::printf("%-14s cases %ld, failed %ld, worst ratio to tolerance %.3g: --first %ld "
                    "--cases 1\n",
                    kKindNames[k], w.cases, w.failed, w.ratio, w.at);
    }
    std::printf("seed %ld, cases %ld, failures %ld\n", seed, cases, failed);
    return failed == 0 ? 0 : 1;
}
