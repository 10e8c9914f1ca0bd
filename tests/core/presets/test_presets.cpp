#include <doctest/doctest.h>

#include "core/analysis/geometry_report.h"
#include "core/geometry/rotation_log.h"
#include "core/geometry/wrench_matrix.h"
#include "core/presets/presets.h"
#include "support/pose_helpers.h"

using namespace spidar;

namespace {

// Published numbers of devices that are in doubt (Springhead's driver; see THIRDPARTY.md): as in presets.cpp.
struct Published {
    const char *name;
    StringVectors motors_m;
    StringVectors joints_m;
};

// As published until 2023: two joints in the wrong places.
const Published kX4{
    "SpidarG6X4",
    {{Vec3(0.069, -0.095, -0.069), Vec3(0.069, -0.095, 0.069), Vec3(-0.069, -0.095, 0.069),
      Vec3(-0.069, -0.095, -0.069), Vec3(0.069, 0.095, -0.069), Vec3(0.069, 0.095, 0.069),
      Vec3(-0.069, 0.095, 0.069), Vec3(-0.069, 0.095, -0.069)}},
    {{Vec3(0, -0.0225, 0), Vec3(0, -0.0225, 0), Vec3(0.0225, 0, 0), Vec3(-0.0225, 0, 0),
      Vec3(0, 0.0225, 0), Vec3(0, 0.0225, 0), Vec3(0.0225, 0, 0), Vec3(-0.0225, 0, 0)}}};
const Published kX3f{
    "SpidarG6X3F",
    {{Vec3(-0.06, -0.073, 0.06), Vec3(0.06, -0.073, 0.06), Vec3(0.06, -0.073, -0.06),
      Vec3(-0.06, -0.073, -0.06), Vec3(-0.06, 0.073, 0.06), Vec3(0.06, 0.073, 0.06),
      Vec3(0.06, 0.073, -0.06), Vec3(-0.06, 0.073, -0.06)}},
    {{Vec3(-0.016, 0, 0), Vec3(0, 0, 0.016), Vec3(0.016, 0, 0), Vec3(0, 0, -0.016),
      Vec3(-0.016, 0, 0), Vec3(0, 0, 0.016), Vec3(0.016, 0, 0), Vec3(0, 0, -0.016)}}};
const Published kT1{
    "SpidarG6T1",
    {{Vec3(-0.03708, -0.09, 0), Vec3(-0.0775, -0.09, 0), Vec3(0.0775, -0.09, 0),
      Vec3(0.03708, -0.09, 0), Vec3(0, 0.07359, -0.16209), Vec3(0, 0.0829, -0.13535),
      Vec3(0, 0.10897, -0.03943), Vec3(0, 0.11912, 0.00323)}},
    {{Vec3(0, -0.0192, 0.023), Vec3(0, -0.0192, -0.023), Vec3(0, -0.0192, 0.023),
      Vec3(0, -0.0192, -0.023), Vec3(0.023, 0.0192, 0), Vec3(-0.023, 0.0192, 0),
      Vec3(0.023, 0.0192, 0), Vec3(-0.023, 0.0192, 0)}}};

GeometryReport report_of(const Published &device) {
    FrameGeometry frame;
    frame.motors_m = device.motors_m;
    const GripGeometry grip = make_rigid_grip(device.joints_m);
    REQUIRE(validate(frame).empty());
    REQUIRE(validate(grip, frame).empty());
    return report_geometry(frame, grip, 0.3, 20.0, 200);
}

bool says(const GeometryReport &report, const char *what) {
    for (const std::string &complaint : report.complaints) {
        if (complaint.find(what) != std::string::npos) {
            return true;
        }
    }
    return false;
}

} // namespace

TEST_CASE("presets: each is valid, of full rank, closed at rest and over most of its workspace") {
    for (int i = 0; i < kPresetCount; ++i) {
        const DevicePreset device = device_preset(static_cast<Preset>(i));
        CAPTURE(device.name);
        CHECK(validate(device.frame).empty());
        CHECK(validate(device.grip, device.frame).empty());
        CHECK(device.metres_per_count > 1e-6);
        CHECK(device.min_tension_n < device.max_tension_n);
        const GeometryReport report =
            report_geometry(device.frame, device.grip, device.min_tension_n, 10.0, 200);
        CHECK(report.sound());
        CHECK(report.at_rest.rank == report.degrees_of_freedom);
        CHECK(report.at_rest.closed);
        CHECK(report.at_rest.margin > 0.9);
        CHECK(report.closure_share > 0.5);
        CHECK(report.force_capacity_n > 5.0);
        CHECK(report.moment_capacity_nm > 0.1);
    }
}

TEST_CASE("presets: the share of poses that the strings can hold is the one that others computed") {
    // 4000 poses within 20 mm and 30 degrees: X3R 91.2, X5R 96.1, X5L 96.8, X4 93.6 % (another program, other draws).
    const auto share = [](Preset preset) {
        const DevicePreset device = device_preset(preset);
        test::Random random(1);
        int closed = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 position_m(random.between(-0.02, 0.02), random.between(-0.02, 0.02),
                                  random.between(-0.02, 0.02));
            const Vec3 axis(random.between(-1.0, 1.0), random.between(-1.0, 1.0),
                            random.between(-1.0, 1.0));
            const double angle_rad = random.between(0.0, glm::radians(30.0));
            const GripPose pose = make_pose(device.grip, position_m,
                                            rotation_exp(angle_rad * glm::normalize(axis)), 0.0);
            closed += pose_statics(device.frame, device.grip, pose).closed ? 1 : 0;
        }
        return closed / 4000.0;
    };
    CHECK(share(Preset::spidar_g6_x3r) == doctest::Approx(0.912).epsilon(0.03));
    CHECK(share(Preset::spidar_g6_x5r) == doctest::Approx(0.961).epsilon(0.03));
    CHECK(share(Preset::spidar_g6_x5l) == doctest::Approx(0.968).epsilon(0.03));
    CHECK(share(Preset::spidar_g6_x4) == doctest::Approx(0.936).epsilon(0.03));
}

TEST_CASE(
    "presets: X5L is X5R for the other hand: turned by a half about z and a quarter about y") {
    const DevicePreset right = device_preset(Preset::spidar_g6_x5r);
    const DevicePreset left = device_preset(Preset::spidar_g6_x5l);
    const auto turned = [](const Vec3 &v) { return Vec3(v.z, -v.y, v.x); };
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(glm::distance(left.frame.motors_m[i], turned(right.frame.motors_m[i])) < 1e-12);
        CHECK(glm::distance(left.grip.joints_m[i], turned(right.grip.joints_m[i])) < 1e-12);
    }
}

TEST_CASE("presets: the left-hand device mirrors the right-hand one") {
    const DevicePreset right = device_preset(Preset::spidar_g6_x3r);
    const DevicePreset left = device_preset(Preset::spidar_g6_x3l);
    // x and y change sign together: a half turn about z of the frame, with the joints mirrored.
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 &r = right.frame.motors_m[i];
        CHECK(glm::distance(left.frame.motors_m[i], Vec3(-r.x, -r.y, r.z)) < 1e-12);
        const Vec3 &j = right.grip.joints_m[i];
        CHECK(glm::distance(left.grip.joints_m[i], Vec3(-j.x, -j.y, j.z)) < 1e-12);
    }
}

TEST_CASE("geometry report: capacity at the paper's centre is what the geometry gives") {
    // At rest along x the eight strings share alike: each pulls with tau x / l, four one way, four the other.
    const DevicePreset paper = device_preset(Preset::paper);
    const GeometryReport report = report_geometry(paper.frame, paper.grip, 0.0, 10.0, 1);
    CHECK(report.force_capacity_n > 0.0);
    const WrenchMatrix matrix = wrench_matrix(paper.frame, paper.grip, rest_pose(paper.grip));
    double most = 0.0; // no more than all strings that help, at their limit
    for (const PaperWrench &column : matrix.columns) {
        most += column[0] > 0.0 ? 10.0 * column[0] : 0.0;
    }
    CHECK(report.force_capacity_n <= most + 1e-6);
    const GeometryReport twice = report_geometry(paper.frame, paper.grip, 0.0, 20.0, 1);
    CHECK(twice.force_capacity_n == doctest::Approx(2.0 * report.force_capacity_n).epsilon(1e-5));
    CHECK(twice.moment_capacity_nm ==
          doctest::Approx(2.0 * report.moment_capacity_nm).epsilon(1e-5));
}

TEST_CASE("geometry report: devices as published that cannot hold their grip, and why") {
    const GeometryReport x4 = report_of(kX4);
    CHECK_FALSE(x4.at_rest.closed);
    CHECK(x4.closure_share < 0.05);
    CHECK(x4.force_capacity_n == 0.0);
    CHECK(says(x4, "the turn about y"));
    CHECK(says(x4, "exchanged"));
    const GeometryReport x3f = report_of(kX3f);
    CHECK_FALSE(x3f.at_rest.closed);
    CHECK(x3f.closure_share == 0.0);
    CHECK(says(x3f, "the turn about y"));
    const GeometryReport t1 = report_of(kT1);
    CHECK_FALSE(t1.sound());
    CHECK_FALSE(t1.at_rest.closed);
}

TEST_CASE("geometry report: what no string opposes is found, and no string works against it") {
    FrameGeometry frame;
    frame.motors_m = kX3f.motors_m;
    const GripGeometry grip = make_rigid_grip(kX3f.joints_m);
    const GripPose rest = rest_pose(grip);
    const PoseStatics statics = pose_statics(frame, grip, rest);
    const WrenchMatrix matrix = wrench_matrix(frame, grip, rest);
    for (const PaperWrench &column : matrix.columns) {
        double work = 0.0;
        for (std::size_t k = 0; k < column.size(); ++k) {
            const double weight = k < 3 ? 1.0 : 1.0 / grip.pole_half_length_m;
            work += weight * column[k] * statics.unopposed[k];
        }
        CHECK(work > -1e-6);
    }
}

TEST_CASE("geometry report: one string twice and lost rank are named") {
    DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    device.frame.motors_m[4] = device.frame.motors_m[0];
    device.grip.joints_m[4] = device.grip.joints_m[0];
    const GeometryReport report = report_geometry(device.frame, device.grip, 0.3, 10.0, 10);
    CHECK(says(report, "Motors 1 and 5 and their joints are in one place"));
    // All strings to two points: the turn about the line between them is out of reach.
    StringVectors joints = device.grip.joints_m;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        joints[i] = i % 2 == 0 ? Vec3(0.02, 0, 0) : Vec3(-0.02, 0, 0);
    }
    const PoseStatics statics = pose_statics(device_preset(Preset::spidar_g6_x3r).frame,
                                             make_rigid_grip(joints), rest_pose(device.grip));
    CHECK(statics.rank < 6);
    CHECK_FALSE(statics.closed);
}
