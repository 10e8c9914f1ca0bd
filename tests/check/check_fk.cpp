// Every row solved cold, with no memory of the row before; the pose and the frame derived from it are compared with
// the reference.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "check/checks.h"
#include "check/csv_reader.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar::check {

namespace {

// Clean rows: rounding of the lengths over the weakest singular value, with a factor of ten.
constexpr double kCleanFloor_m = 1e-14;
constexpr double kCleanOverSigma7_m = 2e-14;
// Rows with length errors end at the least-squares pose.
constexpr double kNoisyTolerance_m = 1e-9;
// Rank-deficient rows: refused, flagged, or this close (square root of rounding, times 60).
constexpr double kRankDeficientTolerance_m = 1e-6;
// Rounding of the angles themselves, in radians.
constexpr double kAngleFloor_rad = 2e-15;

struct Columns {
    std::size_t id, kind, x, y, z, r1x, r1y, r1z, r2x, r2y, r2z, qw, qx, qy, qz, psi, grasp, sigma7;
    std::array<std::size_t, kStringCount> lengths{};

    explicit Columns(const CsvTable &t)
        : id(t.column("id")), kind(t.column("kind")), x(t.column("x")), y(t.column("y")),
          z(t.column("z")), r1x(t.column("r1x")), r1y(t.column("r1y")), r1z(t.column("r1z")),
          r2x(t.column("r2x")), r2y(t.column("r2y")), r2z(t.column("r2z")), qw(t.column("qw")),
          qx(t.column("qx")), qy(t.column("qy")), qz(t.column("qz")), psi(t.column("psi")),
          grasp(t.column("grasp")), sigma7(t.column("sigma7")) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            lengths[i] = t.column("l" + std::to_string(i + 1));
        }
    }
};

struct KindReport {
    int rows = 0;
    int refused = 0;
    int flagged = 0;
    int failed = 0;
    double worst_error_m = 0.0;
    double worst_ratio = 0.0; // of any error to its tolerance
    std::string worst_id = "-";
    std::string worst_what = "-";
};

bool starts_with(const std::string &text, const char *prefix) {
    return text.rfind(prefix, 0) == 0;
}

double pose_tolerance_m(const std::string &kind, double sigma7) {
    if (kind == "rank_deficient") {
        return kRankDeficientTolerance_m;
    }
    if (starts_with(kind, "noise") || kind == "quantised") {
        return kNoisyTolerance_m;
    }
    return kCleanFloor_m + kCleanOverSigma7_m / sigma7;
}

// Refusing is right only where the pose is out of reach or undetermined.
bool may_be_refused(const std::string &kind, Status status) {
    return (kind == "outside_z" &&
            (status == Status::outside_frame || status == Status::impossible_lengths)) ||
           (kind == "rank_deficient" && status == Status::rank_deficient);
}

// Angle between two rotations, without the cancellation of an arc cosine.
double rotation_error_rad(const glm::dquat &expected, const Mat3 &rotation) {
    const glm::dquat actual = glm::quat_cast(rotation);
    const double sign = glm::dot(expected, actual) < 0.0 ? -1.0 : 1.0;
    const glm::dquat difference = expected - actual * sign;
    return 2.0 * std::sqrt(glm::dot(difference, difference));
}

struct RowErrors {
    double pose_m = 0.0;
    double ratio = 0.0;
    const char *what = "position";

    void include(double error, double tolerance, const char *name) {
        const double relative = error / tolerance;
        if (!(relative <= ratio)) { // NaN counts as the worst
            ratio = std::isnan(relative) ? HUGE_VAL : relative;
            what = name;
        }
    }
};

RowErrors compare(const CsvTable &t, std::size_t row, const Columns &c, const GripPose &pose,
                  double tolerance_m, double d) {
    const auto n = [&](std::size_t column) { return t.number(row, column); };
    const double position = glm::distance(pose.position_m, Vec3(n(c.x), n(c.y), n(c.z)));
    const double pole1 = glm::distance(pose.r1_m, Vec3(n(c.r1x), n(c.r1y), n(c.r1z)));
    const double pole2 = glm::distance(pose.r2_m, Vec3(n(c.r2x), n(c.r2y), n(c.r2z)));
    RowErrors errors;
    errors.pose_m = std::fmax(position, std::fmax(pole1, pole2));
    errors.include(position, tolerance_m, "position");
    errors.include(pole1, tolerance_m, "r1");
    errors.include(pole2, tolerance_m, "r2");

    // What an error of the pole ends does to the angles: each pole turns by error / d, and the frame
    // is built from r1 + r2 and r2 - r1, so the shorter of the two magnifies it.
    const GripFrame frame = frame_of(pose, Mat3(1.0));
    const double pole_rad = (tolerance_m + kAngleFloor_rad * d) / d;
    errors.include(std::fabs(frame.crossing_angle_rad - n(c.psi)), 2.0 * pole_rad + kAngleFloor_rad,
                   "psi");
    errors.include(std::fabs(frame.grasp_angle_rad - n(c.grasp)), 2.0 * pole_rad + kAngleFloor_rad,
                   "grasp");
    const double shorter = std::fmin(std::sin(0.5 * n(c.psi)), std::cos(0.5 * n(c.psi)));
    errors.include(
        rotation_error_rad(glm::dquat(n(c.qw), n(c.qx), n(c.qy), n(c.qz)), frame.rotation),
        2.0 * pole_rad / shorter + kAngleFloor_rad, "rotation");
    return errors;
}

} // namespace

int check_fk(const char *path) {
    const CsvTable table(path);
    const Columns columns(table);
    const GripGeometry grip;
    ForwardKinematics kinematics;
    const Status configured = kinematics.configure(make_box_frame(Vec3(kPaperHalfExtent_m)), grip);
    if (!usable(configured)) {
        std::fprintf(stderr, "spidar_check: %s\n", describe(configured));
        return 1;
    }

    std::map<std::string, KindReport> kinds;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        StringArray lengths{};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            lengths[i] = table.number(row, columns.lengths[i]);
        }
        const std::string &kind = table.text(row, columns.kind);
        const std::string &id = table.text(row, columns.id);
        const double tolerance = pose_tolerance_m(kind, table.number(row, columns.sigma7));
        KindReport &report = kinds[kind];
        ++report.rows;
        const KinematicsResult result = kinematics.solve_cold(lengths);
        // A refused row's numbers are read all the same: a malformed row must not hide behind it.
        const RowErrors errors =
            compare(table, row, columns, result.pose, tolerance, grip.pole_half_length_m);
        if (!usable(result.status)) {
            ++report.refused;
            if (!may_be_refused(kind, result.status)) {
                ++report.failed;
                std::printf("row id %s (%s): refused: %s\n", id.c_str(), kind.c_str(),
                            describe(result.status));
            }
            continue;
        }
        const bool flagged = result.status != Status::ok;
        report.flagged += flagged ? 1 : 0;
        if (!(errors.ratio <= report.worst_ratio)) {
            report.worst_ratio = errors.ratio;
            report.worst_id = id;
            report.worst_what = errors.what;
        }
        report.worst_error_m = std::fmax(report.worst_error_m, errors.pose_m);
        const bool excused = kind == "rank_deficient" && flagged;
        if (!(errors.ratio <= 1.0) && !excused) {
            ++report.failed;
            std::printf("row id %s (%s): error %.3g m, %s %.3g times past its tolerance\n",
                        id.c_str(), kind.c_str(), errors.pose_m, errors.what, errors.ratio);
        }
    }

    int failures = 0;
    std::printf("%-16s %6s %8s %8s %8s  %-14s %-12s %s\n", "kind", "rows", "refused", "flagged",
                "failed", "worst error m", "worst ratio", "worst row id (what)");
    for (const auto &[kind, report] : kinds) {
        failures += report.failed;
        std::printf("%-16s %6d %8d %8d %8d  %-14.3g %-12.3g %s (%s)\n", kind.c_str(), report.rows,
                    report.refused, report.flagged, report.failed, report.worst_error_m,
                    report.worst_ratio, report.worst_id.c_str(), report.worst_what.c_str());
    }
    std::printf("rows %zu, failures %d\n", table.row_count(), failures);
    if (table.row_count() == 0) {
        std::fprintf(stderr, "spidar_check: %s has no rows; nothing was checked.\n", path);
        return 1;
    }
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::check
