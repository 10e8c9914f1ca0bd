// Section VI.2: Figs. 6 to 12 and the grasp force, plain and weighted, at three largest tensions.
#include <cmath>

#include "paper/paper_device.h"
#include "paper/sections.h"
#include "paper/wrench_capacity.h"

namespace spidar::paper {

namespace {

constexpr double kForce_n = 5.0; // the paper's
constexpr double kMoments_nm[] = {0.05, 0.1, 0.2};

struct Sweep {
    const char *figure;
    int moved_axis; // of position or rotation
    bool rotated;   // else moved
    int wrench_dof; // which entry of q is asked for
    double sign;
};

// Figs. 6 and 7: +5 N and -5 N along X. 8: along Z. 9 and 10: moment about X, outward (with the rotation for
// positive angles) and restoring. 11 and 12: the same about Z. Y beside X; the rest shows what happens across.
constexpr Sweep kForceSweeps[] = {
    {"fig6", 0, false, 0, 1.0},       {"fig7", 0, false, 0, -1.0},
    {"fig6_y", 1, false, 1, 1.0},     {"fig7_y", 1, false, 1, -1.0},
    {"fig8", 2, false, 2, 1.0},       {"fig8_negative", 2, false, 2, -1.0},
    {"fz_along_x", 0, false, 2, 1.0}, {"fz_negative_along_x", 0, false, 2, -1.0},
    {"fx_along_z", 2, false, 0, 1.0}, {"fx_turned_about_x", 0, true, 0, 1.0},
};
constexpr Sweep kMomentSweeps[] = {
    {"fig9", 0, true, 3, 1.0},     {"fig10", 0, true, 3, -1.0}, {"fig9_y", 1, true, 4, 1.0},
    {"fig10_y", 1, true, 4, -1.0}, {"fig11", 2, true, 5, 1.0},  {"fig12", 2, true, 5, -1.0},
};

const char *name_of(Weighting weighting) {
    return weighting == Weighting::plain ? "plain" : "weighted";
}

void write(CsvFile &table, const char *figure, Weighting weighting, double max_tension_n,
           double asked, double at, const Capacity &capacity) {
    const PaperWrench &u = capacity.unwanted;
    table.row({figure, name_of(weighting), max_tension_n, asked, at, capacity.ratio,
               std::hypot(u[0], u[1], u[2]), std::hypot(u[3], u[4], u[5]), std::abs(u[6])});
}

void run(CsvFile &table, const PaperDevice &device, const Sweep &sweep, double asked) {
    constexpr int kPoints = 81; // 5 mm
    constexpr int kAngles = 73; // 2.5 degrees
    const int count = sweep.rotated ? kAngles : kPoints;
    const double half = sweep.rotated ? 90.0 : 20.0;
    PaperWrench wrench{};
    wrench[static_cast<std::size_t>(sweep.wrench_dof)] = sweep.sign * asked;
    for (const Weighting weighting : {Weighting::plain, Weighting::pole_ends}) {
        for (const double max_tension_n : kMaxTensions_n) {
            for (int i = 0; i < count; ++i) {
                const double at = grid_value(i, count, half);
                const GripPose pose =
                    sweep.rotated
                        ? make_pose(device.grip, Vec3(0.0),
                                    rotation_about(sweep.moved_axis, at * kDegree_rad), 0.0)
                        : make_pose(device.grip, 0.01 * at * axis_vector(sweep.moved_axis),
                                    Mat3(1.0), 0.0);
                write(table, sweep.figure, weighting, max_tension_n, sweep.sign * asked, at,
                      capacity_of(wrench_matrix(device.frame, device.grip, pose), wrench, weighting,
                                  device.grip.pole_half_length_m, max_tension_n));
            }
        }
    }
}

// Grasp force against grasp angle at the centre; its smallest capacity is what the claim stands on.
void grasp(CsvFile &table, const PaperDevice &device, Outputs &outputs) {
    constexpr int kAngles = 37; // 2.5 degrees
    double smallest = 1.0;
    for (const double g : kMoments_nm) {
        for (const double sign : {1.0, -1.0}) {
            for (const Weighting weighting : {Weighting::plain, Weighting::pole_ends}) {
                for (const double max_tension_n : kMaxTensions_n) {
                    for (int i = 0; i < kAngles; ++i) {
                        const double at = grid_value(i, kAngles, 45.0);
                        const GripPose pose =
                            make_pose(device.grip, Vec3(0.0), Mat3(1.0), at * kDegree_rad);
                        PaperWrench wrench{};
                        wrench[6] = sign * g;
                        const Capacity capacity =
                            capacity_of(wrench_matrix(device.frame, device.grip, pose), wrench,
                                        weighting, device.grip.pole_half_length_m, max_tension_n);
                        smallest = std::fmin(smallest, capacity.ratio);
                        write(table, "grasp", weighting, max_tension_n, sign * g, at, capacity);
                    }
                }
            }
        }
    }
    outputs.figure("capacity_grasp_smallest", smallest);
}

} // namespace

void capacity(Outputs &outputs) {
    const PaperDevice device;
    CsvFile table = outputs.table(
        "capacity", "figure,weighting,max_tension_n,asked,at,capacity,unwanted_force_n,"
                    "unwanted_moment_nm,unwanted_grasp_nm");
    for (const Sweep &sweep : kForceSweeps) {
        run(table, device, sweep, kForce_n);
    }
    for (const Sweep &sweep : kMomentSweeps) {
        for (const double moment : kMoments_nm) {
            run(table, device, sweep, moment);
        }
    }
    grasp(table, device, outputs);
}

} // namespace spidar::paper
