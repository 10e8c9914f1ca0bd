// Holds a rigid body to the tool. A kinematic anchor without shape follows the tool's proxy, and a
// 6-DOF joint with all axes locked ties the body to the anchor. Friction between pads and body
// would lose thin bodies in a game engine. Scene coordinates. Main thread only.
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

    // Grasps `body` at its present pose. The nodes of anchor and joint get a parent that is an
    // internal child of `hand`. off_centre_m: place of the body along the grip's x axis, from the
    // middle between the pads; the body is moved to the middle.
    void attach(godot::Node3D &hand, godot::RigidBody3D &body, const godot::Transform3D &grip,
                double off_centre_m);
    // Releases the body and limits its speed to 2 device m/s. Safe while the body leaves the tree.
    // workspace_scale: scene meters per device meter.
    void detach(double workspace_scale);

    [[nodiscard]] bool holds() const noexcept { return body_id_ != 0; }
    // Returns null when no body is held or the body was freed.
    [[nodiscard]] godot::RigidBody3D *body() const;
    [[nodiscard]] std::uint64_t body_id() const noexcept { return body_id_; }
    // False when the body was disabled or freed, or is frozen.
    [[nodiscard]] bool is_movable() const;

    // Advances by one physics tick. Call it once per tick before where() and follow().
    void advance(double delta_s);
    // Keeps the body at `seat`, wherever the grip goes, until the next advance(). Ignored if `seat`
    // is not finite.
    void detain(const godot::Transform3D &seat);
    [[nodiscard]] bool is_detained() const noexcept { return detained_; }
    // Returns the body's target pose in the grip.
    [[nodiscard]] godot::Transform3D in_grip() const;
    // Returns the body's target pose when the grip is at `grip`.
    [[nodiscard]] godot::Transform3D where(const godot::Transform3D &grip) const {
        return grip * in_grip();
    }
    // Returns the grip at which the pads are shown: around the body as drawn, even if the body is
    // detained away from the grip.
    [[nodiscard]] godot::Transform3D carried_grip() const;
    // Moves the anchor to the grip. While the game's time stands still, the body is neither tied
    // nor moved: GodotPhysics divides by the time step, and the position would become NaN.
    void follow(const godot::Transform3D &grip);
    // Puts body and anchor at their targets for `grip` at once, for a distance that a physics step
    // cannot cover.
    void jump(const godot::Transform3D &grip);
    // Returns the distance (scene meters) between the body and its place at the anchor. It is large
    // when something pulls the body away.
    [[nodiscard]] double stretch_m() const;

private:
    void tie(const godot::Transform3D &anchor_at);
    void untie();
    void tie_body();
    void untie_body();
    [[nodiscard]] godot::Transform3D centred(const godot::Transform3D &grip) const;
    [[nodiscard]] double off_centre_moved() const noexcept;
    // Returns the offset from the grip that remains while a body comes from its seat to the grip.
    [[nodiscard]] godot::Transform3D way_left() const;

    std::uint64_t body_id_ = 0;
    bool detained_ = false;
    bool time_runs_ = true;
    godot::Node3D *rig_ = nullptr;
    godot::AnimatableBody3D *anchor_ = nullptr;
    godot::Generic6DOFJoint3D *joint_ = nullptr;
    godot::Transform3D caught_; // pose of the body in the anchor's frame when it was grasped
    double off_centre_m_ = 0.0;
    godot::Transform3D seat_;
    godot::Transform3D from_seat_; // anchor's pose in the grip when the body was last detained
    double free_s_ = 0.0;          // time since the body was last detained
    double age_s_ = 0.0;
};

} // namespace spidar
