// A joint of the servo loop, from where its two frames are in the scene.
#pragma once

#include <cstdint>

#include <glm/matrix.hpp>

#include <godot_cpp/variant/transform3d.hpp>

#include "device/contact/proxy/tool_joint.h"
#include "godot/base/type_conversions.h"
#include "godot/base/world_frame.h"

namespace spidar {

// object: the instance id of what ties. base: of the other body, in the world. tool: of the held body, in the grip; scene metres.
// Nothing moves yet, and all axes are locked.
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
