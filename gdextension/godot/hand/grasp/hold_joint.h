// Holds a rigid body to the tool. A kinematic anchor without shape follows the tool's proxy, and a
// 6-DOF joint with all axes locked ties the body to it. Squeezing by friction alone loses thin
// bodies in a game engine. Scene coordinates. Main thread only.
#pragma once

#include <cstdint>

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/transform3d.hpp>

namespace godot {
class AnimatableBody3D;
class Generic6DOFJoint3D;
class RigidBody3D;
} // namespace godot

namespace spidar {

class HoldJoint {
public:
    HoldJoint() = default;
    HoldJoint(const HoldJoint &) = delete;
    HoldJoint &operator=(const HoldJoint &) = delete;

    // Grasps `body` at its present pose; the joint's nodes become internal children of `hand`.
    // off_centre_m: distance along the grip's x axis by which the body is moved to the middle
    // between the pads.
    void attach(godot::Node3D &hand, godot::RigidBody3D &body, const godot::Transform3D &grip,
                double off_centre_m);
    // Releases the body; safe while it leaves the tree. workspace_scale: scene m per device m.
    void detach(double workspace_scale);

    [[nodiscard]] bool holds() const noexcept { return body_id_ != 0; }
    // Returns null when no body is held or the body was freed.
    [[nodiscard]] godot::RigidBody3D *body() const;
    [[nodiscard]] std::uint64_t body_id() const noexcept { return body_id_; }
    // False when the body was disabled, frozen or freed.
    [[nodiscard]] bool is_movable() const;

    // Advances by one physics frame. Call it once per frame before where() and follow().
    void advance(double delta_s);
    // Keeps the body at `seat`, wherever the grip goes, until the next advance().
    void detain(const godot::Transform3D &seat);
    [[nodiscard]] bool is_detained() const noexcept { return detained_; }
    // Returns the body's target pose in the grip.
    [[nodiscard]] godot::Transform3D in_grip() const;
    // Returns the body's target pose when the grip is at `grip`.
    [[nodiscard]] godot::Transform3D where(const godot::Transform3D &grip) const {
        return grip * in_grip();
    }
    // Returns where the pads hold the body: at the body, also while it is detained in a seat.
    [[nodiscard]] godot::Transform3D carried_grip() const;
    // Moves the anchor to the grip. While the game's time stands still the body is neither tied nor
    // moved: GodotPhysics divides by the time step, and the body's position would become NaN.
    void follow(const godot::Transform3D &grip);
    // Puts body and anchor at their targets for `grip`, which may be farther away than a physics
    // step can move them.
    void jump(const godot::Transform3D &grip);
    // Returns the distance (scene meters) of the body from where the anchor last held it. Large
    // when something pulls the body away.
    [[nodiscard]] double stretch_m() const;

private:
    void tie(const godot::Transform3D &anchor_at);
    void untie();
    void tie_body();
    void untie_body();
    [[nodiscard]] godot::Transform3D centred(const godot::Transform3D &grip) const;
    [[nodiscard]] double off_centre_moved() const noexcept;
    // Returns the rest of the way from the seat to the grip, relative to the grip.
    [[nodiscard]] godot::Transform3D way_left() const;

    std::uint64_t body_id_ = 0;
    bool detained_ = false;
    bool time_runs_ = true;
    godot::Node3D *rig_ = nullptr;
    godot::AnimatableBody3D *anchor_ = nullptr;
    godot::Generic6DOFJoint3D *joint_ = nullptr;
    godot::Transform3D caught_; // from the anchor to the body, when caught
    double off_centre_m_ = 0.0;
    godot::Transform3D seat_;
    godot::Transform3D from_seat_; // pose in the grip when last detained
    double free_s_ = 0.0;          // time since last detained
    double age_s_ = 0.0;
};

} // namespace spidar
