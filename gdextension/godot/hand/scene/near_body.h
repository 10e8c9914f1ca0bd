// One physics body near the hand: its shapes, pose, motion and surface. Main thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/transform3d.hpp>

#include "device/contact/shapes/placement.h"
#include "godot/base/node_motion.h"
#include "godot/base/world_frame.h"
#include "godot/hand/scene/body_facts.h"
#include "godot/hand/scene/shape_shelf.h"

namespace godot {
class CollisionObject3D;
}

namespace spidar {

struct BodyShape {
    godot::RID shape;
    godot::Transform3D local;
    std::int32_t id = 0;
    std::int64_t owner = -1; // shape owner in a CollisionObject3D; below 0: none
    bool disabled = false;
    bool listed = false; // among Surroundings' nearest shapes in the last tick
    // A ball around the shape in the body's frame (scene units, without the body's own scale). An
    // infinite radius: unknown.
    Vec3 middle{0.0};
    double radius = 0.0;
    std::uint64_t bounded = 0; // Source::bounds for which the ball was computed; 0: none yet
    std::shared_ptr<ShapeShelf::Source> source;
};

// Poses and motion of the device's node in this tick.
struct Moment {
    WorldFrame now;                   // pose of the node in this tick
    WorldFrame in_space;              // pose of the node at the last physics step
    const NodeMotion *node = nullptr; // motion of the node until that step
    double tick_s = 0.0;
    double time_scale = 1.0; // Engine.time_scale; 0 while physics stands still
};

// Calls use(owner, index, disabled) for each shape of the body that has a shape owner. index: place
// in the physics server's list of the body's shapes.
void for_owned_shapes(
    godot::CollisionObject3D &body,
    const std::function<void(std::uint32_t owner, std::size_t index, bool disabled)> &use);

class NearBody {
public:
    NearBody(const godot::RID &rid, std::uint64_t object);

    [[nodiscard]] const godot::RID &rid() const noexcept { return rid_; }
    [[nodiscard]] std::uint64_t object() const noexcept { return object_; }
    // Returns whether the physics server still has the body in that space. Call it in each tick
    // before the other functions.
    [[nodiscard]] bool is_there(const godot::RID &space);

    // Reads mode, pose and motion.
    void read_place(const Moment &moment);
    // Updates the list of shapes. Of a body with many shapes, only the listed ones and a few others
    // are read in each tick. next_id: the next free id; each new shape takes one.
    void read_shapes(ShapeShelf &shelf, std::int32_t &next_id);
    void read_facts(BodyFactsReader &reader);
    // Returns whether the body has `other` among its collision exceptions; false for a body without
    // a node, whose exceptions are unknown.
    [[nodiscard]] bool spares(std::uint64_t other) const;

    [[nodiscard]] std::string name() const;
    [[nodiscard]] godot::PhysicsServer3D::BodyMode mode() const noexcept { return mode_; }
    [[nodiscard]] bool moved_by_physics() const noexcept {
        return mode_ >= godot::PhysicsServer3D::BODY_MODE_RIGID;
    }
    [[nodiscard]] double mass_kg() const noexcept { return mass_kg_; } // 0 unless physics moves it
    [[nodiscard]] const BodyFacts &facts() const noexcept { return facts_; }
    [[nodiscard]] std::vector<BodyShape> &shapes() noexcept { return shapes_; }

    // Axes with their scale, in the scene.
    [[nodiscard]] const Mat3 &basis() const noexcept { return basis_; }
    // Origin in the scene.
    [[nodiscard]] const Vec3 &origin() const noexcept { return origin_; }
    // WorldFrame of the device's node at the time to which the body's pose belongs.
    [[nodiscard]] const WorldFrame &frame() const noexcept { return frame_; }
    // Velocity of the body relative to the device's node, in the device frame, in meters per second
    // of device time.
    [[nodiscard]] Vec3 velocity_at(const Vec3 &point_m) const noexcept {
        return velocity_m_s_ + glm::cross(angular_rad_s_, point_m - center_m_);
    }
    [[nodiscard]] const Vec3 &angular_rad_s() const noexcept { return angular_rad_s_; }
    // Velocity of a surface that runs like a conveyor belt, from the body's constant velocities.
    // Zero for a body that physics moves. Device frame.
    [[nodiscard]] Vec3 belt_velocity_at(const Vec3 &point_m) const noexcept {
        return belt_m_s_ + glm::cross(belt_rad_s_, point_m - center_m_);
    }
    [[nodiscard]] const Vec3 &belt_rad_s() const noexcept { return belt_rad_s_; }

    std::int64_t near_tick = 0;  // last tick in which one of the body's shapes was near
    std::int64_t facts_tick = 0; // tick of the next read_facts()
    bool spares_held = false;    // the held body is among this body's collision exceptions

private:
    void read_list(ShapeShelf &shelf, std::int32_t &next_id, int count);
    void read_shape(ShapeShelf &shelf, int index);
    void read_owners();
    static void bound(BodyShape &shape);
    void read_moved(const Moment &moment);
    void read_belt(const Moment &moment);
    void set_place(const godot::Transform3D &place);

    godot::RID rid_;
    std::uint64_t object_;
    godot::PhysicsDirectBodyState3D *state_ = nullptr; // in this tick
    // True if the object is the CollisionObject3D that made the body, and so has shape owners.
    bool is_node_ = false;
    std::vector<BodyShape> shapes_;
    std::size_t rolling_ = 0;
    godot::PhysicsServer3D::BodyMode mode_ = godot::PhysicsServer3D::BODY_MODE_STATIC;
    double mass_kg_ = 0.0;
    BodyFacts facts_;
    Mat3 basis_{1.0};
    Vec3 origin_{0.0};
    WorldFrame frame_;
    NodeMotion motion_; // of bodies that physics does not move, device frame
    Vec3 center_m_{0.0};
    Vec3 velocity_m_s_{0.0};
    Vec3 angular_rad_s_{0.0};
    Vec3 belt_m_s_{0.0}; // at center_m_
    Vec3 belt_rad_s_{0.0};
};

// The axes of a pose, split into rotation and scale.
struct TurnAndScale {
    Mat3 turn{1.0};
    Vec3 scale{1.0};      // negative x: mirrored
    bool sheared = false; // axes not perpendicular, or one with zero or infinite length
};
[[nodiscard]] TurnAndScale take_apart(const Mat3 &axes) noexcept;

} // namespace spidar
