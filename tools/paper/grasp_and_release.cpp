// The end of section VI.3: at every point of the 40 cm cube the grip can be grasped and released.
#include <algorithm>
#include <cmath>

#include "core/kinematics/forward_kinematics.h"
#include "paper/measured_strings.h"
#include "paper/paper_device.h"
#include "paper/sections.h"
#include "paper/wrench_capacity.h"

namespace spidar::paper {

namespace {

constexpr int kGrid = 17; // every 2.5 cm
constexpr double kOpen_rad = 0.0;
constexpr double kClosed_rad = 35.0 * kDegree_rad; // the middle of the paper's 20 to 50
constexpr double kGrasp_nm = 0.1;
constexpr double kMaxTension_n = 10.0;

// Held at each angle for as long as the detector wants to be sure.
bool reads_as(GraspDetector &detector, double angle_rad, GraspPhase wanted) {
    constexpr double kTick_s = 0.001;
    constexpr int kTicks = 100;
    for (int tick = 0; tick < kTicks; ++tick) {
        detector.update(angle_rad, kTick_s);
    }
    return detector.phase() == wanted;
}

struct Tally {
    int points = 0;
    int good = 0;
    int refused = 0;
    double open_low = 180.0;
    double open_high = -180.0;
    double closed_low = 180.0;
    double closed_high = -180.0;
};

Tally read_everywhere(const PaperDevice &device, const StringErrorModel &model,
                      const Mat3 &rotation) {
    ForwardKinematics kinematics;
    kinematics.configure(device.frame, device.grip);
    Tally tally;
    for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
        const Vec3 position(grid_value(i % kGrid, kGrid, kCubeHalf_m),
                            grid_value(i / kGrid % kGrid, kGrid, kCubeHalf_m),
                            grid_value(i / kGrid / kGrid, kGrid, kCubeHalf_m));
        bool usable_here = true;
        const auto angle_read = [&](double angle_rad) {
            const GripPose pose = make_pose(device.grip, position, rotation, angle_rad);
            const KinematicsResult read = kinematics.solve_cold(
                model.readings_m(string_lengths(device.frame, device.grip, pose)));
            usable_here = usable_here && usable(read.status);
            return frame_of(read.pose, Mat3(1.0)).grasp_angle_rad;
        };
        const double open = angle_read(kOpen_rad);
        const double closed = angle_read(kClosed_rad);
        ++tally.points;
        if (!usable_here) {
            ++tally.refused;
            continue;
        }
        GraspDetector detector;
        // In this order: && would skip the later ones.
        const bool was_open = reads_as(detector, open, GraspPhase::open);
        const bool was_grasped = reads_as(detector, closed, GraspPhase::grasped);
        const bool was_released = reads_as(detector, open, GraspPhase::open);
        tally.good += was_open && was_grasped && was_released ? 1 : 0;
        tally.open_low = std::min(tally.open_low, open / kDegree_rad);
        tally.open_high = std::max(tally.open_high, open / kDegree_rad);
        tally.closed_low = std::min(tally.closed_low, closed / kDegree_rad);
        tally.closed_high = std::max(tally.closed_high, closed / kDegree_rad);
    }
    return tally;
}

// Can the grasp also be felt there? g = +-0.1 N m at every point.
void felt_everywhere(const PaperDevice &device, Outputs &outputs) {
    int full = 0;
    int points = 0;
    double smallest = 1.0;
    double largest_force_n = 0.0;
    for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
        const Vec3 position(grid_value(i % kGrid, kGrid, kCubeHalf_m),
                            grid_value(i / kGrid % kGrid, kGrid, kCubeHalf_m),
                            grid_value(i / kGrid / kGrid, kGrid, kCubeHalf_m));
        double here = 1.0;
        for (const double sign : {1.0, -1.0}) {
            const GripPose pose = make_pose(device.grip, position, Mat3(1.0), kClosed_rad);
            const Capacity capacity =
                capacity_of(wrench_matrix(device.frame, device.grip, pose),
                            {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, sign * kGrasp_nm}, Weighting::pole_ends,
                            device.grip.pole_half_length_m, kMaxTension_n);
            here = std::fmin(here, capacity.ratio);
            const PaperWrench &u = capacity.unwanted;
            largest_force_n = std::fmax(largest_force_n, std::hypot(u[0], u[1], u[2]));
        }
        ++points;
        full += here >= 0.95 ? 1 : 0;
        smallest = std::fmin(smallest, here);
    }
    outputs.figure("grasp_felt/full_percent", 100.0 * full / points);
    outputs.figure("grasp_felt/smallest", smallest);
    outputs.figure("grasp_felt/unwanted_force_max_n", largest_force_n);
}

} // namespace

void grasp_and_release(Outputs &outputs, const std::string &data_folder) {
    const PaperDevice device;
    const std::vector<StringRow> rows = read_table1(data_folder);
    CsvFile table = outputs.table("grasp_and_release",
                                  "strings,rotation_y_deg,points,good,refused,open_low_deg,"
                                  "open_high_deg,closed_low_deg,closed_high_deg");
    struct Case {
        const char *strings;
        StringErrorModel::Method method;
    };
    for (const Case &one :
         {Case{"exact", StringErrorModel::Method::ideal}, Case{"M2", StringErrorModel::Method::m2},
          Case{"M1", StringErrorModel::Method::m1}}) {
        const StringErrorModel model(rows, one.method);
        for (const double angle_deg : {0.0, 45.0}) {
            const Tally tally =
                read_everywhere(device, model, rotation_about(1, angle_deg * kDegree_rad));
            table.row({one.strings, angle_deg, tally.points, tally.good, tally.refused,
                       tally.open_low, tally.open_high, tally.closed_low, tally.closed_high});
            const std::string name =
                std::string("/") + one.strings + (angle_deg == 0.0 ? "; upright" : "; Ry 45 deg");
            outputs.figure("grasp_good_percent" + name, 100.0 * tally.good / tally.points);
        }
    }
    felt_everywhere(device, outputs);
}

} // namespace spidar::paper
