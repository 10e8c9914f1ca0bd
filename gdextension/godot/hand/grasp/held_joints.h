// Converts the joints of a held body for the servo loop: hinges, slides and sockets with their
// limits, springs, dampers and motors. docs/why/contact_engine.md, "Held things on joints", gives
// the engine's sign conventions. Main thread only.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "device/contact/proxy/tool_joint.h"
#include "godot/base/world_frame.h"
#include "godot/hand/grasp/scene_joints.h"

namespace godot {
class RigidBody3D;
}

namespace spidar {

class HeldJoints {
public:
    // Takes the joints of a newly grasped body, at most kMaxToolJoints. Returns how many more it
    // has.
    int take(SceneJoints &joints, const godot::RigidBody3D &body);
    void drop() {
        held_.clear();
        bases_.clear();
    }

    // Returns the present joints to the world and to bodies other than an unfrozen RigidBody3D,
    // which would give way. in_grip: pose of the held body in the grip, scene meters. frame: of the
    // device's node. tick_s: length of a physics tick.
    [[nodiscard]] std::vector<ToolJoint> now(const godot::RigidBody3D &body,
                                             const godot::Transform3D &in_grip,
                                             const WorldFrame &frame, double tick_s);

private:
    std::vector<SceneJoints::Found> held_;
    // Poses of the joints' frames on the other bodies in the last tick, for their velocities.
    std::unordered_map<std::uint64_t, Placement> bases_;
};

} // namespace spidar
