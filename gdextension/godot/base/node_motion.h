// Measures how the SpidarG node moves through the scene. Objects that move with the node are at
// rest for the device, so the node's velocity is subtracted from velocities in the scene before
// they reach the device.
#pragma once

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "godot/base/world_frame.h"

namespace spidar {

class NodeMotion {
public:
    // Called once per physics tick with the node's pose. tick_s: time since the previous call.
    void note(const WorldFrame &place, double tick_s) noexcept {
        if (known_) {
            const Mat3 turn = place.rotation * glm::transpose(place_.rotation);
            linear_.take((place.origin - place_.origin) / tick_s);
            angular_.take(rotation_log(turn) / tick_s);
        }
        place_ = place;
        known_ = true;
    }
    // Returns the velocity of a point that is fixed to the node (unit: scene m/s). from_origin:
    // vector from the node's origin to the point, in scene axes.
    [[nodiscard]] Vec3 velocity_at(const Vec3 &from_origin) const noexcept {
        return linear_.steady + glm::cross(angular_.steady, from_origin);
    }
    [[nodiscard]] const Vec3 &angular_rad_s() const noexcept { return angular_.steady; }

private:
    // steady: the velocity of the newest tick, with at most the magnitude of the tick before; zero
    // if the two directions differ by 90 degrees or more. When a script teleports a resting node,
    // the node has a velocity in one tick only, so that `steady` stays zero.
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
