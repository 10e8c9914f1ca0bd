// Bodies that two hands hold: where each hand would have the body. Scene coordinates. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector3.hpp>

namespace spidar {

struct SharedHold {
    std::uint64_t hand = 0;  // instance id
    godot::Transform3D body; // as this hand would have it
    godot::Vector3 velocity; // of the body's origin
    godot::Vector3 turning;
};

// Of a hand that holds the body now; again in each tick.
void note_hold(std::uint64_t body, const SharedHold &hold);
void forget_hold(std::uint64_t body, std::uint64_t hand);
[[nodiscard]] std::vector<SharedHold> other_holds(std::uint64_t body, std::uint64_t hand);
// In the middle of all that the hands would have.
[[nodiscard]] godot::Transform3D shared_place(const godot::Transform3D &mine,
                                              const std::vector<SharedHold> &others);

} // namespace spidar
