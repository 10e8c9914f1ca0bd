// The joints that tie a held body, as the servo loop takes them: its hinges, slides and sockets, their limits, springs,
// dampers and motors. Which way the engine counts is told in docs/why/contact_engine.md, "Held things on joints". Main thread only.
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
    // A body has just been caught. Returns how many of its joints are more than the servo loop takes.
    int take(SceneJoints &joints, const godot::RigidBody3D &body);
    void drop() {
        held_.clear();
        bases_.clear();
    }

    // Those to something that stands or is moved by itself, as they are now. in_grip: of the held body, scene metres; frame: of the device's node; tick_s: of a physics tick.
    [[nodiscard]] std::vector<ToolJoint> now(const godot::RigidBody3D &body,
                                             const godot::Transform3D &in_grip,
                                             const WorldFrame &frame, double tick_s);

private:
    std::vector<SceneJoints::Found> held_;
    // By the joint, of the last tick: how fast it moves.
    std::unordered_map<std::uint64_t, Placement> bases_;
};

} // namespace spidar
