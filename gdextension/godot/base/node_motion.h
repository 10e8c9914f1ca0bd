// How the node moves through the scene. What moves along with the node is at rest for the device, so the node's own velocity
// is taken off the velocities of the scene before they reach the device.
#pragma once

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "godot/base/world_frame.h"

namespace spidar {

class NodeMotion {
public:
    // Takes the node's newest place, tick_s after the one before.
    void note(const WorldFrame &place, double tick_s) noexcept {
        if (known_) {
            const Mat3 turn = place.rotation * glm::transpose(place_.rotation);
            linear_.take((place.origin - place_.origin) / tick_s);
            angular_.take(rotation_log(turn) / tick_s);
        }
        place_ = place;
        known_ = true;
    }
    // Velocity of a point that is fixed to the node (unit: scene m/s). from_origin: from the node's origin to the point, in the
    // axes of the scene.
    [[nodiscard]] Vec3 velocity_at(const Vec3 &from_origin) const noexcept {
        return linear_.steady + glm::cross(angular_.steady, from_origin);
    }
    [[nodiscard]] const Vec3 &angular_rad_s() const noexcept { return angular_.steady; }

private:
    // The part of a velocity that two ticks in a row share: a node that a script puts elsewhere has a velocity in one tick
    // alone.
    struct Rate {
        Vec3 seen{0.0};
        Vec3 steady{0.0};
        void take(const Vec3 &newest) noexcept {
            const double last_2 = glm::dot(seen, seen);
            const double newest_2 = glm::dot(newest, newest);
            if (!(glm::dot(seen, newest) > 0.0)) {
                steady = Vec3(0.0);
            } else {
                steady = newest_2 > last_2 ? std::sqrt(last_2 / newest_2) * newest : newest;
            }
            seen = newest;
        }
    };

    WorldFrame place_;
    bool known_ = false;
    Rate linear_;
    Rate angular_;
};

} // namespace spidar
