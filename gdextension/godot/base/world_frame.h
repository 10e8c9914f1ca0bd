// Converts between scene coordinates ("world") and the device frame: x_world = origin + scale *
// rotation * x_device. Forces and moments are rotated but not scaled.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "device/contract/dof_lanes.h"
#include "device/contract/haptic_command.h"
#include "godot/base/type_conversions.h"

namespace spidar {

struct WorldFrame {
    Mat3 rotation{1.0};
    Vec3 origin{0.0};
    double scale = 1.0; // scene meters per device meter

    // Returns false for a node with a scale of zero, and for an origin that is not finite.
    [[nodiscard]] bool usable() const noexcept {
        constexpr double kRoundingOfFloats = 1e-3;
        const double turn = std::abs(glm::determinant(rotation));
        return std::abs(turn - 1.0) < kRoundingOfFloats &&
               std::isfinite(origin.x + origin.y + origin.z);
    }

    // Returns the frame of a node. Node scale and mirroring are removed (the node warns about
    // them). mirrored_axis: the axis (0 to 2) to flip back in a mirrored node, or -1.
    static WorldFrame of(const godot::Transform3D &node, double workspace_scale,
                         int mirrored_axis) {
        Mat3 rotation = to_core(node.basis.orthonormalized());
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == mirrored_axis) {
                rotation[axis] = -rotation[axis];
            }
        }
        return {rotation, to_core(node.origin), workspace_scale};
    }
    // Returns -1 for a node that is not mirrored. A mirrored node is a rotated node with one axis
    // flipped, and each of the three axes can be that one. Returns the axis with which the rotation
    // is smallest, so that a scene that is only mirrored is not rotated.
    static int mirrored_axis_of(const godot::Transform3D &node) {
        const Mat3 axes = to_core(node.basis.orthonormalized());
        if (!(glm::determinant(axes) < 0.0)) {
            return -1;
        }
        int least = 0;
        for (int axis = 1; axis < 3; ++axis) {
            least = axes[axis][axis] < axes[least][least] ? axis : least;
        }
        return least;
    }

    [[nodiscard]] Vec3 point_to_world(const Vec3 &device) const noexcept {
        return origin + scale * (rotation * device);
    }
    [[nodiscard]] Vec3 point_to_device(const Vec3 &world) const noexcept {
        return glm::transpose(rotation) * (world - origin) / scale;
    }
    // For forces, moments, normals and angular velocities, which are not scaled.
    [[nodiscard]] Vec3 turn_to_world(const Vec3 &device) const noexcept {
        return rotation * device;
    }
    [[nodiscard]] Vec3 turn_to_device(const Vec3 &world) const noexcept {
        return glm::transpose(rotation) * world;
    }
    [[nodiscard]] Vec3 velocity_to_world(const Vec3 &device) const noexcept {
        return scale * (rotation * device);
    }
    [[nodiscard]] Vec3 velocity_to_device(const Vec3 &world) const noexcept {
        return glm::transpose(rotation) * world / scale;
    }
    [[nodiscard]] godot::Transform3D pose_to_world(const Vec3 &position, const Mat3 &turn) const {
        return {to_godot(rotation * turn), to_godot(point_to_world(position))};
    }
    [[nodiscard]] Wrench wrench_to_device(const Wrench &world) const noexcept {
        return {turn_to_device(world.force_n), turn_to_device(world.moment_nm),
                world.grasp_torque_nm};
    }
    // Returns fx fy fz mx my mz grasp_torque in world axes.
    [[nodiscard]] DofLanes wrench_to_world(const Wrench &device) const noexcept {
        return lanes(turn_to_world(device.force_n), turn_to_world(device.moment_nm),
                     device.grasp_torque_nm);
    }
    // Converts a plane dot(normal, x) >= offset from scene to device. A grasp stop is unchanged; of
    // a turn stop, axis and angular velocity are rotated.
    [[nodiscard]] ContactPlane contact_to_device(ContactPlane contact) const noexcept {
        if (contact.target == ContactTarget::grasp_stop) {
            return contact;
        }
        if (contact.target == ContactTarget::turn_stop) {
            contact.normal = turn_to_device(contact.normal);
            contact.velocity_m_s = turn_to_device(contact.velocity_m_s);
            return contact; // the angle is the same in both frames
        }
        contact.offset_m = (contact.offset_m - glm::dot(contact.normal, origin)) / scale;
        contact.normal = turn_to_device(contact.normal);
        contact.velocity_m_s = velocity_to_device(contact.velocity_m_s);
        return contact;
    }
};

} // namespace spidar
