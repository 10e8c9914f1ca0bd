#include "device/contact/touch/touch_scene.h"

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"
#include "core/base/sound_state.h"

namespace spidar {

namespace {

Status validate_traits(const SurfaceTraits &traits) noexcept {
    const SurfaceTexture &texture = traits.texture;
    if (!all_finite(traits.static_friction, traits.adhesion_n, traits.magnet_n,
                    traits.magnet_range_m, texture.wavelength_m, texture.depth_m, texture.across)) {
        return Status::not_finite;
    }
    const bool smooth = texture.depth_m == 0.0;
    if (texture.relief != nullptr && texture.relief->kind() != ShapeKind::relief) {
        return Status::invalid_request;
    }
    const bool good = traits.static_friction >= 0.0 && traits.adhesion_n >= 0.0 &&
                      traits.magnet_n >= 0.0 && traits.magnet_range_m >= 0.0 &&
                      (smooth || (texture.depth_m > 0.0 && texture.wavelength_m > 0.0));
    return good ? Status::ok : Status::invalid_request;
}

Status validate_part(const ScenePart &part) noexcept {
    if (!all_finite(part.at) ||
        !all_finite(part.velocity_m_s, part.angular_rad_s, part.belt_m_s, part.belt_rad_s,
                    part.stiffness_n_m, part.damping_n_s_m, part.friction)) {
        return Status::not_finite;
    }
    const bool good = part.shape != nullptr && part.shape->kind() != ShapeKind::relief &&
                      part.stiffness_n_m >= 0.0 && part.damping_n_s_m >= 0.0 &&
                      part.friction >= 0.0 &&
                      are_flags(part.traits.catches_again, part.stiffness_at_once);
    return good ? validate_traits(part.traits) : Status::invalid_request;
}

Status validate_joint(const ToolJoint &joint) noexcept {
    if (!all_finite(joint.base) || !all_finite(joint.in_grip) ||
        !all_finite(joint.velocity_m_s, joint.angular_rad_s)) {
        return Status::not_finite;
    }
    for (const JointAxis &axis : joint.axes) {
        if (!all_finite(axis.lower, axis.upper, axis.stiffness, axis.rest, axis.damping,
                        axis.motor_speed, axis.motor_most)) {
            return Status::not_finite;
        }
        if (axis.stiffness < 0.0 || axis.damping < 0.0 || axis.motor_most < 0.0) {
            return Status::invalid_request;
        }
    }
    return Status::ok;
}

Status validate_part(const ToolPart &part) noexcept {
    if (!all_finite(part.at)) {
        return Status::not_finite;
    }
    return part.shape != nullptr && part.mount <= ToolMount::jaw_plus ? Status::ok
                                                                      : Status::invalid_request;
}

} // namespace

Status validate(const TouchScene &touch) noexcept {
    const Tool &tool = touch.tool;
    const ContactScene &scene = touch.scene;
    const bool counted = tool.count >= 0 && tool.count <= kMaxToolParts && scene.count >= 0 &&
                         scene.count <= kMaxSceneParts && tool.joint_count >= 0 &&
                         tool.joint_count <= kMaxToolJoints && touch.felt <= kAllDof;
    if (!counted) {
        return Status::invalid_request;
    }
    if (!all_finite(touch.stiffness, touch.damping_n_s_m, touch.load, touch.state_time_s,
                    tool.jaws.open_m, tool.jaws.closed_rad) ||
        std::isnan(tool.stop_rad)) { // infinite when nothing is held
        return Status::not_finite;
    }
    const bool good = touch.damping_n_s_m >= 0.0 && tool.jaws.open_m >= 0.0 &&
                      tool.jaws.closed_rad > 0.0 &&
                      std::ranges::all_of(touch.stiffness, [](double k) { return k >= 0.0; });
    if (!good) {
        return Status::invalid_request;
    }
    for (int t = 0; t < tool.count; ++t) {
        const Status status = validate_part(tool.parts[static_cast<std::size_t>(t)]);
        if (!usable(status)) {
            return status;
        }
    }
    for (int j = 0; j < tool.joint_count; ++j) {
        const Status status = validate_joint(tool.joints[static_cast<std::size_t>(j)]);
        if (!usable(status)) {
            return status;
        }
    }
    for (int s = 0; s < scene.count; ++s) {
        const Status status = validate_part(scene.parts[static_cast<std::size_t>(s)]);
        if (!usable(status)) {
            return status;
        }
    }
    return Status::ok;
}

} // namespace spidar
