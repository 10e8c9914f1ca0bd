#include "core/kinematics/pose_blend.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

double angle_between(const Vec3 &a, const Vec3 &b) noexcept {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Returns `from` turned by that share of the angle to `to`, along the great circle; for opposite
// poles along any.
Vec3 turned_towards(const Vec3 &from, const Vec3 &to, double share) noexcept {
    const double size = glm::length(from);
    const Vec3 n = from / size;
    Vec3 way = to - n * glm::dot(n, to);
    if (!(glm::length(way) > 1e-9 * size)) {
        if (glm::dot(from, to) > 0.0) {
            return to;
        }
        const Vec3 axis = std::fabs(n.z) < 0.7 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
        way = axis - n * glm::dot(n, axis);
    }
    const double angle = share * angle_between(from, to);
    return size * (std::cos(angle) * n + std::sin(angle) * glm::normalize(way));
}

// Returns the pole moved by the change of the found pole.
Vec3 carried(const Vec3 &pole, const Vec3 &change) noexcept {
    return glm::length(pole) * glm::normalize(pole + change);
}

} // namespace

void PoseBlend::start(const GripPose &shown, const GripPose &found) noexcept {
    shown_ = shown;
    found_ = found;
    const double arc_m = glm::length(found.r1_m) * std::max(angle_between(shown.r1_m, found.r1_m),
                                                            angle_between(shown.r2_m, found.r2_m));
    const double way_m = glm::distance(shown.position_m, found.position_m) + arc_m;
    const double steps = std::min(way_m / kStep_m, static_cast<double>(kLongest_ticks - 1));
    left_ = steps >= 0.0 ? 1 + static_cast<int>(steps)
                         : 1; // a distance that is not a number counts as zero
}

GripPose PoseBlend::next(const GripPose &found) noexcept {
    if (left_ <= 1) {
        left_ = 0;
        shown_ = found;
        return found;
    }
    const double share = 1.0 / left_--;
    shown_.position_m += found.position_m - found_.position_m;
    shown_.position_m += share * (found.position_m - shown_.position_m);
    shown_.r1_m = turned_towards(carried(shown_.r1_m, found.r1_m - found_.r1_m), found.r1_m, share);
    shown_.r2_m = turned_towards(carried(shown_.r2_m, found.r2_m - found_.r2_m), found.r2_m, share);
    found_ = found;
    return shown_;
}

} // namespace spidar
