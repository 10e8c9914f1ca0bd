// Where every wrench can be made with strings that only pull: maps, fractions of the cube, limits on the axes.
#include <array>
#include <functional>

#include "paper/closure.h"
#include "paper/paper_device.h"
#include "paper/sections.h"

namespace spidar::paper {

namespace {

constexpr int kPositionPoints = 81; // every 5 mm
constexpr int kAnglePoints = 73;    // every 2.5 degrees
constexpr int kRandomPoses = 20000;

Closure closure_at(const PaperDevice &device, const GripPose &pose) {
    return closure_of(wrench_matrix(device.frame, device.grip, pose),
                      device.grip.pole_half_length_m);
}

// Three of position (m), three of rotation (rad), grasp angle (rad).
using Coordinates = std::array<double, kDofCount>;

GripPose pose_at(const PaperDevice &device, const Coordinates &at) {
    return make_pose(device.grip, Vec3(at[0], at[1], at[2]),
                     rotation_zyx(Vec3(at[3], at[4], at[5])), at[6]);
}

void maps(const PaperDevice &device, Outputs &outputs) {
    struct Plane {
        const char *name;
        std::size_t u;
        std::size_t v;
        bool angles;
    };
    CsvFile table = outputs.table("closure_map", "plane,u,v,margin,closed");
    for (const Plane &plane :
         {Plane{"x_y", 0, 1, false}, Plane{"x_z", 0, 2, false}, Plane{"y_z", 1, 2, false},
          Plane{"rx_ry", 3, 4, true}, Plane{"rx_rz", 3, 5, true}, Plane{"rz_grasp", 5, 6, true}}) {
        const int count = plane.angles ? kAnglePoints : kPositionPoints;
        const double half = plane.angles ? 90.0 : 20.0; // degrees or cm
        const double unit = plane.angles ? kDegree_rad : 0.01;
        for (int i = 0; i < count; ++i) {
            for (int j = 0; j < count; ++j) {
                Coordinates at{};
                at[plane.u] = grid_value(i, count, half) * unit;
                at[plane.v] = grid_value(j, count, half) * unit;
                const Closure closure = closure_at(device, pose_at(device, at));
                table.row({plane.name, at[plane.u] / unit, at[plane.v] / unit, closure.margin,
                           closure.closed});
            }
        }
    }
}

// Share of `kRandomPoses` that are closed, in percent.
double share(const PaperDevice &device, const std::function<GripPose(Random &)> &draw) {
    Random random(1);
    int closed = 0;
    for (int i = 0; i < kRandomPoses; ++i) {
        closed += closure_at(device, draw(random)).closed ? 1 : 0;
    }
    return 100.0 * closed / kRandomPoses;
}

void shares(const PaperDevice &device, Outputs &outputs) {
    CsvFile table = outputs.table("closure_share", "poses,theory_1_percent,theory_2_percent");
    const auto turned = [&](int axis, double angle_deg, double grasp_deg) {
        return [&device, axis, angle_deg, grasp_deg](Random &random) {
            return make_pose(device.grip, random.in_cube(kCubeHalf_m),
                             rotation_about(axis, angle_deg * kDegree_rad),
                             grasp_deg * kDegree_rad);
        };
    };
    const auto mixed = [&](double cube_m, double tilt_deg, double grasp_deg) {
        return [&device, cube_m, tilt_deg, grasp_deg](Random &random) {
            return random.pose(device.grip, cube_m, tilt_deg * kDegree_rad,
                               grasp_deg * kDegree_rad);
        };
    };
    const auto add = [&](const char *name, const std::function<GripPose(Random &)> &draw) {
        const double percent = share(device, draw);
        // Theory 1 counts strings: 8 > 7 at every pose.
        table.row({name, 100.0, percent});
        outputs.figure(std::string("closure_share_percent/") + name, percent);
    };
    add("40 cm cube; upright", turned(0, 0.0, 0.0));
    add("40 cm cube; Rx 30 deg", turned(0, 30.0, 0.0));
    add("40 cm cube; Ry 30 deg", turned(1, 30.0, 0.0));
    add("40 cm cube; Rz 30 deg", turned(2, 30.0, 0.0));
    add("40 cm cube; Rx 60 deg", turned(0, 60.0, 0.0));
    add("40 cm cube; Rz 60 deg", turned(2, 60.0, 0.0));
    add("40 cm cube; upright; grasp 45 deg", turned(0, 0.0, 45.0));
    add("20 cm cube; tilt 30 deg; grasp 30 deg", mixed(0.5 * kCubeHalf_m, 30.0, 30.0));
    add("40 cm cube; tilt 30 deg; grasp 30 deg", mixed(kCubeHalf_m, 30.0, 30.0));
    add("40 cm cube; tilt 60 deg; grasp 45 deg", mixed(kCubeHalf_m, 60.0, 45.0));
}

// Largest value of one coordinate, all others at rest, up to which closure holds; `end` when it is never lost.
double limit(const PaperDevice &device, std::size_t coordinate, double end) {
    constexpr int kSteps = 500;     // so that a gap on the way is seen
    constexpr int kBisections = 40; // to 1e-14 of a step
    double inside = 0.0;
    double outside = end;
    bool lost = false;
    const auto closed = [&](double value) {
        Coordinates at{};
        at[coordinate] = value;
        return closure_at(device, pose_at(device, at)).closed;
    };
    for (int i = 1; i <= kSteps && !lost; ++i) {
        outside = end * i / kSteps;
        lost = !closed(outside);
        inside = lost ? inside : outside;
    }
    for (int i = 0; i < kBisections && lost; ++i) {
        const double middle = 0.5 * (inside + outside);
        (closed(middle) ? inside : outside) = middle;
    }
    return inside;
}

void limits(const PaperDevice &device, Outputs &outputs) {
    CsvFile table = outputs.table("closure_limit", "coordinate,unit,searched_to,negative,positive");
    const char *names[] = {"x", "y", "z", "rotation_x", "rotation_y", "rotation_z", "grasp_angle"};
    for (std::size_t k = 0; k < kDofCount; ++k) {
        const bool angle = k >= 3;
        const double unit = angle ? kDegree_rad : 0.01;
        const double end = angle ? 89.0 : 23.9;
        const double negative = limit(device, k, -end * unit) / unit;
        const double positive = limit(device, k, end * unit) / unit;
        table.row({names[k], angle ? "deg" : "cm", end, negative, positive});
        outputs.figure(std::string("closure_limit_") + (angle ? "deg/" : "cm/") + names[k],
                       positive);
    }
}

} // namespace

void closure_map(Outputs &outputs) {
    const PaperDevice device;
    maps(device, outputs);
    shares(device, outputs);
    limits(device, outputs);
}

} // namespace spidar::paper
