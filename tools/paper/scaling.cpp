// "Scalability": what a larger frame or longer poles change, at the centre and in the middle of the frame.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/kinematics/forward_kinematics.h"
#include "paper/closure.h"
#include "paper/paper_device.h"
#include "paper/sections.h"
#include "paper/wrench_capacity.h"

namespace spidar::paper {

namespace {

constexpr double kMaxTension_n = 10.0;

PaperDevice device_of(double half_extent_m, double pole_half_length_m) {
    PaperDevice device;
    device.frame = make_box_frame(Vec3(half_extent_m));
    device.grip.pole_half_length_m = pole_half_length_m;
    return device;
}

bool closed_at(const PaperDevice &device, const GripPose &pose) {
    return closure_of(wrench_matrix(device.frame, device.grip, pose),
                      device.grip.pole_half_length_m)
        .closed;
}

// Largest x of closure as a part of the half frame, and its part of the cube of 20/24 of the frame.
void closure(const PaperDevice &device, double half_extent_m, double &reach,
             double &share_percent) {
    constexpr int kBisections = 40;
    constexpr int kGrid = 21; // every 2 cm in the paper's frame
    double outside = 1.0;
    reach = 0.0;
    for (int i = 0; i < kBisections; ++i) {
        const double part = 0.5 * (reach + outside);
        const Vec3 at(part * half_extent_m, 0.0, 0.0);
        (closed_at(device, make_pose(device.grip, at, Mat3(1.0), 0.0)) ? reach : outside) = part;
    }
    const double half = half_extent_m * kCubeHalf_m / kPaperHalfExtent_m;
    int closed = 0;
    for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
        const Vec3 at(grid_value(i % kGrid, kGrid, half),
                      grid_value(i / kGrid % kGrid, kGrid, half),
                      grid_value(i / kGrid / kGrid, kGrid, half));
        closed += closed_at(device, make_pose(device.grip, at, Mat3(1.0), 0.0)) ? 1 : 0;
    }
    share_percent = 100.0 * closed / (kGrid * kGrid * kGrid);
}

struct Noise {
    double position = 0.0;       // m of position for a metre of string noise (rms, per axis)
    double rotation_rad_m = 0.0; // all three axes together
    double grasp_rad_m = 0.0;
};

// Equal independent noise in all strings, through the real kinematics at the centre.
Noise noise_gain(const PaperDevice &device) {
    constexpr int kTrials = 2000;
    const double size_m = 1e-5 * device.grip.pole_half_length_m; // small: the linear gain is wanted
    ForwardKinematics kinematics;
    kinematics.configure(device.frame, device.grip);
    const StringArray rest = string_lengths(device.frame, device.grip, rest_pose(device.grip));
    Random random(3);
    Noise sum;
    for (int trial = 0; trial < kTrials; ++trial) {
        StringArray lengths = rest;
        for (double &length : lengths) {
            length += size_m * std::sqrt(3.0) * random.between(-1.0, 1.0); // rms size_m
        }
        const KinematicsResult read = kinematics.solve_cold(lengths);
        const GripFrame frame = frame_of(read.pose, Mat3(1.0));
        const glm::dquat turn = glm::quat_cast(frame.rotation);
        const double angle =
            2.0 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
        sum.position += glm::dot(read.pose.position_m, read.pose.position_m) / 3.0;
        sum.rotation_rad_m += angle * angle;
        sum.grasp_rad_m += frame.grasp_angle_rad * frame.grasp_angle_rad;
    }
    const auto root = [&](double squares) { return std::sqrt(squares / kTrials) / size_m; };
    return {root(sum.position), root(sum.rotation_rad_m), root(sum.grasp_rad_m)};
}

void measure(CsvFile &table, const char *sweep, double half_extent_m, double pole_half_length_m,
             Outputs &outputs) {
    const PaperDevice device = device_of(half_extent_m, pole_half_length_m);
    const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, rest_pose(device.grip));
    double reach = 0.0;
    double share_percent = 0.0;
    closure(device, half_extent_m, reach, share_percent);
    const auto most = [&](std::size_t dof, double end) {
        PaperWrench wrench{};
        wrench[dof] = 1.0;
        return largest_exact(matrix, wrench, pole_half_length_m, kMaxTension_n, end);
    };
    const double sum_n = kMaxTension_n * kStringCount; // no wrench is larger
    const double force_x_n = most(0, sum_n);
    const double force_z_n = most(2, sum_n);
    const double moment_x_nm = most(3, sum_n * pole_half_length_m);
    const double moment_z_nm = most(5, sum_n * pole_half_length_m);
    const double g_nm = most(6, sum_n * pole_half_length_m);
    const Noise noise = noise_gain(device);
    table.row({sweep, 2.0 * half_extent_m, pole_half_length_m, reach, share_percent, force_x_n,
               force_z_n, moment_x_nm, moment_z_nm, 0.5 * g_nm, noise.position,
               noise.rotation_rad_m * 0.001 / kDegree_rad,
               noise.grasp_rad_m * 0.001 / kDegree_rad});
    char name[64];
    std::snprintf(name, sizeof(name), "/%s %.2f m; %.1f cm", sweep, 2.0 * half_extent_m,
                  100.0 * pole_half_length_m);
    outputs.figure(std::string("scaling_share_percent") + name, share_percent);
    outputs.figure(std::string("scaling_reach") + name, reach);
    outputs.figure(std::string("scaling_rotation_deg_per_mm") + name,
                   noise.rotation_rad_m * 0.001 / kDegree_rad);
    outputs.figure(std::string("scaling_position") + name, noise.position);
    outputs.figure(std::string("scaling_force_x_n") + name, force_x_n);
    outputs.figure(std::string("scaling_moment_x_nm") + name, moment_x_nm);
}

} // namespace

void scaling(Outputs &outputs) {
    CsvFile table = outputs.table(
        "scaling", "sweep,frame_m,pole_half_length_m,closure_reach,closure_share_percent,"
                   "force_x_n,force_z_n,moment_x_nm,moment_z_nm,grasp_torque_nm,position_mm_per_mm,"
                   "rotation_deg_per_mm,grasp_deg_per_mm");
    constexpr double kPole_m = kPaperPoleHalfLength_m;
    for (const double half_m : {0.08, 0.12, 0.16, 0.20, 0.24, 0.32, 0.50, 0.75, 1.00, 1.50, 2.00}) {
        measure(table, "frame", half_m, kPole_m, outputs);
    }
    for (const double pole_m : {0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.10, 0.12}) {
        measure(table, "pole", kPaperHalfExtent_m, pole_m, outputs);
    }
    for (const double factor : {0.5, 1.0, 2.0, 4.0}) {
        measure(table, "both", factor * kPaperHalfExtent_m, factor * kPole_m, outputs);
    }
}

} // namespace spidar::paper
