// Holds a rigid body to the tool: a kinematic anchor without shape that follows the tool's proxy, and a 6-DOF joint, all axes
// locked, from it to the body. Squeezing by friction alone loses thin bodies in a game engine; this does not. Scene
// coordinates. Main thread only.
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

    // Catches `body` as it is now; the joint's nodes become internal children of `hand`. off_centre_m: how far along the
    // grip's x axis the body is brought back to the middle between the pads.
    void attach(godot::Node3D &hand, godot::RigidBody3D &body, const godot::Transform3D &grip,
                double off_centre_m);
    // Lets go; safe when the body is leaving the tree. workspace_scale: scene metres per device metre.
    void detach(double workspace_scale);

    [[nodiscard]] bool holds() const noexcept { return body_id_ != 0; }
    // Null when none is held, or when it was freed.
    [[nodiscard]] godot::RigidBody3D *body() const;
    [[nodiscard]] std::uint64_t body_id() const noexcept { return body_id_; }
    // False when the body was taken out of the physics, or made one that nothing moves: disabled, frozen or freed.
    [[nodiscard]] bool is_movable() const;

    // Moves on by one physics frame: call once, before where() and follow().
    void advance(double delta_s);
    // Until the next advance() the body stays at `seat`, wherever the grip goes.
    void detain(const godot::Transform3D &seat);
    [[nodiscard]] bool is_detained() const noexcept { return detained_; }
    // Where the body belongs in the grip.
    [[nodiscard]] godot::Transform3D in_grip() const;
    // Where it belongs when the grip is at `grip`.
    [[nodiscard]] godot::Transform3D where(const godot::Transform3D &grip) const {
        return grip * in_grip();
    }
    // Where the pads are that hold the body: with it, also where it sits in a seat of its own.
    [[nodiscard]] godot::Transform3D carried_grip() const;
    // Carries the anchor to the grip. While the game's time stands still the body is neither tied nor carried: GodotPhysics
    // divides by the length of the step, and the body's place becomes NAN.
    void follow(const godot::Transform3D &grip);
    // Puts body and anchor where they belong when the grip is at `grip`, farther away than a physics step can carry them.
    void jump(const godot::Transform3D &grip);
    // Scene metres between the body and where the anchor last held it: large when something tears at it.
    [[nodiscard]] double stretch_m() const;

private:
    void tie(const godot::Transform3D &anchor_at);
    void untie();
    void tie_body();
    void untie_body();
    [[nodiscard]] godot::Transform3D centred(const godot::Transform3D &grip) const;
    [[nodiscard]] double off_centre_moved() const noexcept;
    // What is left of the way from the seat to the grip, from the grip on.
    [[nodiscard]] godot::Transform3D way_left() const;

    std::uint64_t body_id_ = 0;
    bool detained_ = false;
    bool time_runs_ = true;
    godot::Node3D *rig_ = nullptr;
    godot::AnimatableBody3D *anchor_ = nullptr;
    godot::Generic6DOFJoint3D *joint_ = nullptr;
    godot::Transform3D caught_; // from the anchor to the body, as it was when caught
    double off_centre_m_ = 0.0;
    godot::Transform3D seat_;
    godot::Transform3D from_seat_; // in the grip, when it was detained last
    double free_s_ = 0.0;          // since then
    double age_s_ = 0.0;
};

} // namespace spidar
