#include "core/wrench_matrix.h"

#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/string_exit.h"

namespace spidar {

namespace {

// A string shorter than this has no direction: its column is zero (unit: m).
constexpr double kShortestString_m = 1e-9;

} // namespace

WrenchMatrix wrench_matrix(const FrameGeometry &frame, const GripGeometry &grip,
                           const GripPose &pose) noexcept {
    WrenchMatrix matrix;
    const bool rigid = grip.kind == GripKind::rigid;
    const Vec3 cross = glm::cross(pose.r1_m, pose.r2_m);
    const double area = glm::length(cross);
    const double scale = glm::length(pose.r1_m) * glm::length(pose.r2_m);
    matrix.grasp_row_vanishes = rigid || !(area > kParallelAngle_rad * scale);
    // Nearer to parallel than the rotation is trusted, n is noise and would turn g into a noisy moment.
    const Vec3 normal = matrix.grasp_row_vanishes ? Vec3(0.0) : cross / area;

    for (int i = 0; i < kStringCount; ++i) {
        const auto s = static_cast<std::size_t>(i);
        const Attachment &tie = grip.attachments[s];
        const Vec3 lever = attachment_lever(grip, pose, s);
        const StringPath path = string_path(frame, s, pose.position_m + lever);
        // A NaN takes the direction and shows in the column: the solver refuses it by status.
        const Vec3 pull = path.length_m <= kShortestString_m ? Vec3(0.0) : -path.direction;
        const Vec3 moment = glm::cross(lever, pull);
        const double grasp = (tie.pole == 0 ? 1.0 : -1.0) * glm::dot(normal, moment);
        matrix.columns[s] = {pull.x, pull.y, pull.z, moment.x, moment.y, moment.z, grasp};
    }
    return matrix;
}

DofArray apply(const WrenchMatrix &matrix, const StringArray &tensions_n) noexcept {
    DofArray wrench{};
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
        for (std::size_t k = 0; k < wrench.size(); ++k) {
            wrench[k] += matrix.columns[i][k] * tensions_n[i];
        }
    }
    return wrench;
}

StringArray apply_transposed(const WrenchMatrix &matrix, const DofArray &rates) noexcept {
    StringArray shortening{};
    for (std::size_t i = 0; i < matrix.columns.size(); ++i) {
        for (std::size_t k = 0; k < rates.size(); ++k) {
            shortening[i] += matrix.columns[i][k] * rates[k];
        }
    }
    return shortening;
}

} // namespace spidar
