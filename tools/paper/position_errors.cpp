// Section VI.3: Table 2, the 45-degree experiment and the +-4 mm, by way of string errors and the real
// forward kinematics.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <glm/geometric.hpp>

#include "check/csv_reader.h"
#include "core/kinematics/forward_kinematics.h"
#include "paper/measured_strings.h"
#include "paper/paper_device.h"
#include "paper/sections.h"

namespace spidar::paper {

namespace {

constexpr int kRandomPoses = 20000;
constexpr double kClaimed_m = 0.004;

class Reader {
public:
    explicit Reader(const PaperDevice &device) : device_(device) {
        kinematics_.configure(device.frame, device.grip);
    }
    KinematicsResult read(const StringArray &lengths_m) {
        return kinematics_.solve_cold(lengths_m);
    }
    [[nodiscard]] StringArray lengths(const GripPose &pose) const {
        return string_lengths(device_.frame, device_.grip, pose);
    }

private:
    const PaperDevice &device_;
    ForwardKinematics kinematics_;
};

// Angle of the rotation that leads from one frame to the other.
double angle_between(const Mat3 &a, const Mat3 &b) {
    const glm::dquat turn = glm::quat_cast(glm::transpose(a) * b);
    return 2.0 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

// Largest error on one axis: what a reading against a marker shows.
double axis_error(const GripPose &truth, const GripPose &read) {
    const Vec3 error = glm::abs(read.position_m - truth.position_m);
    return std::max({error.x, error.y, error.z});
}

struct ErrorSample {
    std::vector<double> position_m; // of the worst axis
    std::vector<double> rotation_rad;
    int refused = 0;

    void add(const GripPose &truth, const KinematicsResult &read) {
        if (!usable(read.status)) {
            ++refused;
            return;
        }
        position_m.push_back(axis_error(truth, read.pose));
        rotation_rad.push_back(angle_between(frame_of(truth, Mat3(1.0)).rotation,
                                             frame_of(read.pose, Mat3(1.0)).rotation));
    }
};

double rms(const std::vector<double> &values) {
    double sum = 0.0;
    for (const double value : values) {
        sum += value * value;
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

double largest(const std::vector<double> &values) {
    return *std::max_element(values.begin(), values.end());
}

double quantile(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

void table2(Reader &reader, const PaperDevice &device, const StringErrorModel &m2,
            const std::string &data_folder, Outputs &outputs) {
    const check::CsvTable printed(data_folder + "/table2.csv");
    const std::size_t marker = printed.column("marker_cm");
    const std::array<std::size_t, 2> rows = {printed.column("first_row_cm"),
                                             printed.column("second_row_cm")};
    CsvFile table = outputs.table("table2", "axis,marker_cm,paper_cm,model_cm");
    const char *names[] = {"x", "y", "z"};
    std::array<double, 3> most{};
    for (const int axis : {0, 1, 2}) {
        for (std::size_t row = 0; row < printed.row_count(); ++row) {
            const double at_cm = printed.number(row, marker);
            const GripPose pose =
                make_pose(device.grip, 0.01 * at_cm * axis_vector(axis), Mat3(1.0), 0.0);
            const KinematicsResult read = reader.read(m2.readings_m(reader.lengths(pose)));
            const double read_cm = 100.0 * read.pose.position_m[axis];
            // The table's second row: Y by its label, Z by the text.
            const double paper_cm = printed.number(row, rows[axis == 0 ? 0 : 1]);
            table.row({names[axis], at_cm, paper_cm, read_cm});
            const auto k = static_cast<std::size_t>(axis);
            most[k] = std::max(most[k], 1000.0 * axis_error(pose, read.pose));
            if (at_cm == 20.0) {
                outputs.figure(std::string("table2_at_20_cm/") + names[axis], read_cm);
            }
        }
        outputs.figure(std::string("table2_max_mm/") + names[axis],
                       most[static_cast<std::size_t>(axis)]);
    }
    double paper_worst = 0.0;
    double miss = 0.0; // between our model's X line and the paper's
    for (std::size_t row = 0; row < printed.row_count(); ++row) {
        const double at_cm = printed.number(row, marker);
        for (const std::size_t column : rows) {
            paper_worst = std::max(paper_worst, std::abs(printed.number(row, column) - at_cm));
        }
        const GripPose pose = make_pose(device.grip, Vec3(0.01 * at_cm, 0.0, 0.0), Mat3(1.0), 0.0);
        const KinematicsResult read = reader.read(m2.readings_m(reader.lengths(pose)));
        miss =
            std::max(miss, std::abs(100.0 * read.pose.position_m.x - printed.number(row, rows[0])));
    }
    outputs.figure("table2/paper_max_mm", 10.0 * paper_worst);
    outputs.figure("table2/x_model_to_paper_max_mm", 10.0 * miss);
}

// The grip turned by 45 degrees about Y and moved along X and Z.
void turned(Reader &reader, const PaperDevice &device, const std::vector<StringRow> &rows,
            Outputs &outputs) {
    CsvFile table =
        outputs.table("turned_45", "strings,axis,marker_cm,read_deg,position_error_mm,usable");
    const Mat3 truth = rotation_about(1, 45.0 * kDegree_rad);
    for (const auto method : {StringErrorModel::Method::m1, StringErrorModel::Method::m2}) {
        const StringErrorModel model(rows, method);
        const char *name = method == StringErrorModel::Method::m1 ? "M1" : "M2";
        double low = 180.0;
        double high = 0.0;
        double most = 0.0;
        for (const int axis : {0, 2}) {
            for (int at_cm = -20; at_cm <= 20; ++at_cm) {
                const GripPose pose =
                    make_pose(device.grip, 0.01 * at_cm * axis_vector(axis), truth, 0.0);
                const KinematicsResult read = reader.read(model.readings_m(reader.lengths(pose)));
                const double angle_deg =
                    angle_between(Mat3(1.0), frame_of(read.pose, Mat3(1.0)).rotation) / kDegree_rad;
                const double error_mm = 1000.0 * axis_error(pose, read.pose);
                table.row(
                    {name, axis == 0 ? "x" : "z", at_cm, angle_deg, error_mm, usable(read.status)});
                low = std::min(low, angle_deg);
                high = std::max(high, angle_deg);
                most = std::max(most, error_mm);
            }
        }
        outputs.figure(std::string("turned_45_min_deg/") + name, low);
        outputs.figure(std::string("turned_45_max_deg/") + name, high);
        outputs.figure(std::string("turned_45_position_max_mm/") + name, most);
    }
}

void cubes(Reader &reader, const PaperDevice &device, const StringErrorModel &m2,
           Outputs &outputs) {
    CsvFile table = outputs.table("position_error", "strings,poses,part,position_error_mm");
    const auto report = [&](const char *strings, const char *poses, const ErrorSample &sample) {
        const std::string name = std::string("/") + strings + "; " + poses;
        const auto within = std::count_if(sample.position_m.begin(), sample.position_m.end(),
                                          [](double error) { return error <= kClaimed_m; });
        outputs.figure("position_rms_mm" + name, 1000.0 * rms(sample.position_m));
        outputs.figure("position_max_mm" + name, 1000.0 * largest(sample.position_m));
        outputs.figure("rotation_rms_deg" + name, rms(sample.rotation_rad) / kDegree_rad);
        outputs.figure("within_4_mm_percent" + name,
                       100.0 * static_cast<double>(within) /
                           static_cast<double>(sample.position_m.size()));
        outputs.figure("refused" + name, sample.refused);
        for (int percent = 0; percent <= 100; ++percent) {
            table.row({strings, poses, 0.01 * percent,
                       1000.0 * quantile(sample.position_m, 0.01 * percent)});
        }
    };
    using Disturb = std::function<StringArray(const StringArray &, Random &)>;
    const Disturb as_measured = [&](const StringArray &lengths, Random &) {
        return m2.readings_m(lengths);
    };
    const Disturb random_signs = [](const StringArray &lengths, Random &random) {
        StringArray readings = lengths;
        for (double &length : readings) {
            length += random.heads() ? 0.003 : -0.003;
        }
        return readings;
    };
    const Disturb common = [](const StringArray &lengths, Random &) {
        StringArray readings = lengths;
        for (double &length : readings) {
            length += 0.003;
        }
        return readings;
    };
    for (const double tilt_deg : {0.0, 30.0}) {
        const char *poses = tilt_deg == 0.0 ? "upright" : "tilt 30 deg";
        const auto run = [&](const char *strings, const Disturb &disturb) {
            Random random(2);
            ErrorSample sample;
            for (int i = 0; i < kRandomPoses; ++i) {
                const GripPose pose = random.pose(device.grip, kCubeHalf_m, tilt_deg * kDegree_rad,
                                                  tilt_deg * kDegree_rad);
                sample.add(pose, reader.read(disturb(reader.lengths(pose), random)));
            }
            report(strings, poses, sample);
        };
        run("M2 profile", as_measured);
        run("3 mm each; random signs", random_signs);
        run("3 mm common", common);
    }
}

} // namespace

void position_errors(Outputs &outputs, const std::string &data_folder) {
    const PaperDevice device;
    const std::vector<StringRow> rows = read_table1(data_folder);
    const StringErrorModel m2(rows, StringErrorModel::Method::m2);
    Reader reader(device);
    table2(reader, device, m2, data_folder, outputs);
    turned(reader, device, rows, outputs);
    cubes(reader, device, m2, outputs);
}

} // namespace spidar::paper
