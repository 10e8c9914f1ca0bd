// Makes a joint of the servo loop from its two frames in the scene.
#pragma once

#include <cstdint>

#include <glm/matrix.hpp>

#include <godot_cpp/variant/transform3d.hpp>

#include "device/contact/proxy/tool_joint.h"
#include "godot/base/type_conversions.h"
#include "godot/base/world_frame.h"

namespace spidar {

// Returns a joint with all axes locked and a base that does not move; the caller changes both.
// object: instance id of the joint or hand. base: frame on the other body, in the world. tool:
// frame on the held body, in the grip; scene meters. frame: of the device's node.
[[nodiscard]] inline ToolJoint joint_between(std::uint64_t object, const godot::Transform3D &base,
                                             const godot::Transform3D &tool,
                                             const WorldFrame &frame) {
    ToolJoint joint;
    joint.id = static_cast<std::int32_t>(object & 0x7fffffffU);
    joint.base = {frame.point_to_device(to_core(base.origin)),
                  glm::transpose(frame.rotation) * to_core(base.basis.orthonormalized())};
    joint.in_grip = {to_core(tool.origin) / frame.scale, to_core(tool.basis.orthonormalized())};
    return joint;
}

} // namespace spidar
