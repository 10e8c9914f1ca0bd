// Stores the target of each hand for its held body, so that several hands can hold one body. Scene
// coordinates. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector3.hpp>

namespace spidar {

struct SharedHold {
    std::uint64_t hand = 0;  // instance id
    godot::Transform3D body; // pose to which this hand moves the body
    godot::Vector3 velocity; // of the pose's origin
    godot::Vector3 turning;  // angular velocity of the pose (unit: rad/s)
};

// Called in each tick by a hand that holds the body.
void note_hold(std::uint64_t body, const SharedHold &hold);
void forget_hold(std::uint64_t body, std::uint64_t hand);
[[nodiscard]] std::vector<SharedHold> other_holds(std::uint64_t body, std::uint64_t hand);
// Returns the mean of `mine` and the poses of the other hands.
[[nodiscard]] godot::Transform3D shared_place(const godot::Transform3D &mine,
                                              const std::vector<SharedHold> &others);

} // namespace spidar
