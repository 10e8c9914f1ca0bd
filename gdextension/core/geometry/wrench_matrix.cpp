#include "core/geometry/wrench_matrix.h"

#include <glm/geometric.hpp>

#include "core/geometry/pole_lanes.h"
#include "core/geometry/string_exit.h"

namespace spidar {

namespace {

// A string shorter than this has no direction, and its column is zero (unit: m).
constexpr double kShortestString_m = 1e-9;

// Fills the matrix for poles and eyelets, two strings at a time.
void fill_crossed(WrenchMatrix &matrix, const FrameGeometry &frame, const GripGeometry &grip,
                  const GripPose &pose, const Vec3 &normal) noexcept {
    for (std::size_t i = 0; i < matrix.columns.size(); i += 2) {
        const Attachment &one = grip.attachments[i];
        const Attachment &two = grip.attachments[i + 1];
        const LaneVec lever = lanes_of(one.sign * (one.pole == 0 ? pose.r1_m : pose.r2_m),
                                       two.sign * (two.pole == 0 ? pose.r1_m : pose.r2_m));
        const LaneVec line =
            lanes_of(frame.motors_m[i] - pose.position_m, frame.motors_m[i + 1] - pose.position_m) -
            lever;
        const Lanes length = square_root(dot(line, line));
        // A NaN length passes the division and appears in the column: the solver refuses it by
        // status.
        const Lanes over = both(1.0) / length;
        const Lanes inverse = {length[0] <= kShortestString_m ? 0.0 : over[0],
                               length[1] <= kShortestString_m ? 0.0 : over[1]};
        const LaneVec pull = inverse * line;
        const LaneVec moment = {lever.y * pull.z - lever.z * pull.y,
                                lever.z * pull.x - lever.x * pull.z,
                                lever.x * pull.y - lever.y * pull.x};
        const Lanes side = {one.pole == 0 ? 1.0 : -1.0, two.pole == 0 ? 1.0 : -1.0};
        const Lanes grasp = side * (both(normal.x) * moment.x + both(normal.y) * moment.y +
                                    both(normal.z) * moment.z);
        for (int lane = 0; lane < 2; ++lane) {
            matrix.columns[i + static_cast<std::size_t>(lane)] = {
                pull.x[lane],   pull.y[lane],   pull.z[lane], moment.x[lane],
                moment.y[lane], moment.z[lane], grasp[lane]};
        }
    }
}

// Fills the matrix for any grip and any exit.
void fill_general(WrenchMatrix &matrix, const FrameGeometry &frame, const GripGeometry &grip,
                  const GripPose &pose, const Vec3 &normal) noexcept {
    for (int i = 0; i < kStringCount; ++i) {
        const auto s = static_cast<std::size_t>(i);
        const Attachment &tie = grip.attachments[s];
        const Vec3 lever = attachment_lever(grip, pose, s);
        const StringPath path = string_path(frame, s, pose.position_m + lever);
        // A NaN passes and appears in the column: the solver refuses it by status.
        const Vec3 pull = path.length_m <= kShortestString_m ? Vec3(0.0) : -path.direction;
        const Vec3 moment = glm::cross(lever, pull);
        const double grasp = (tie.pole == 0 ? 1.0 : -1.0) * glm::dot(normal, moment);
        matrix.columns[s] = {pull.x, pull.y, pull.z, moment.x, moment.y, moment.z, grasp};
    }
}

} // namespace

WrenchMatrix wrench_matrix(const FrameGeometry &frame, const GripGeometry &grip,
                           const GripPose &pose) noexcept {
    WrenchMatrix matrix;
    set_wrench_matrix(matrix, frame, grip, pose);
    return matrix;
}

void set_wrench_matrix(WrenchMatrix &matrix, const FrameGeometry &frame, const GripGeometry &grip,
                       const GripPose &pose) noexcept {
    const bool rigid = grip.kind == GripKind::rigid;
    const Vec3 cross = glm::cross(pose.r1_m, pose.r2_m);
    const double area = glm::length(cross);
    const double scale = glm::length(pose.r1_m) * glm::length(pose.r2_m);
    matrix.grasp_row_vanishes = rigid || !(area > kParallelAngle_rad * scale);
    // Nearer to parallel than kParallelAngle_rad, n is noise and would turn g into a noisy moment.
    const Vec3 normal = matrix.grasp_row_vanishes ? Vec3(0.0) : cross / area;

    if (rigid || frame.pulley_radius_m > 0.0) {
        fill_general(matrix, frame, grip, pose, normal);
    } else {
        fill_crossed(matrix, frame, grip, pose, normal);
    }
}

PaperWrench apply(const WrenchMatrix &matrix, const StringArray &tensions_n) noexcept {
    Lanes x = both(0.0);
    Lanes y = both(0.0);
    Lanes z = both(0.0);
    double last = 0.0;
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
        const PaperWrench &column = matrix.columns[i];
        const Lanes tension = both(tensions_n[i]);
        x += Lanes{column[0], column[1]} * tension;
        y += Lanes{column[2], column[3]} * tension;
        z += Lanes{column[4], column[5]} * tension;
        last += column[6] * tensions_n[i];
    }
    return {x[0], x[1], y[0], y[1], z[0], z[1], last};
}

StringArray apply_transposed(const WrenchMatrix &matrix, const PaperTwist &rates) noexcept {
    StringArray shortening{};
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
        for (std::size_t k = 0; k < rates.size(); ++k) {
            shortening[i] += matrix.columns[i][k] * rates[k];
        }
    }
    return shortening;
}

} // namespace spidar
