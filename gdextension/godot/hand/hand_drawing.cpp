#include "godot/hand/hand_drawing.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include <godot_cpp/classes/geometry_instance3d.hpp>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/standard_material3d.hpp>
#include <godot_cpp/core/memory.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/pads.h"

namespace spidar {

namespace {

using godot::BaseMaterial3D;
using godot::Color;

const Color kPadsColour(0.35F, 0.75F, 1.0F);
const Color kHeldColour(0.95F, 0.75F, 0.25F);
const Color kProxyColour(0.2F, 0.9F, 0.4F);
const Color kDeviceColour(0.7F, 0.7F, 0.75F);
const Color kNormalColour(0.9F, 0.9F, 0.2F);
const Color kForceColour(0.85F, 0.15F, 0.55F);
constexpr double kNormal_m = 0.01;
constexpr double kForce_m_n = 0.015;
constexpr double kLargest_m = 0.5; // of what is endless no more is drawn
constexpr int kSectors = 24;

} // namespace

void HandDrawing::prepare(godot::Node3D &hand) {
    if (instance_ != nullptr) {
        return;
    }
    mesh_.instantiate();
    godot::Ref<godot::StandardMaterial3D> material;
    material.instantiate();
    material->set_shading_mode(BaseMaterial3D::SHADING_MODE_UNSHADED);
    material->set_flag(BaseMaterial3D::FLAG_ALBEDO_FROM_VERTEX_COLOR, true);
    material->set_flag(BaseMaterial3D::FLAG_DISABLE_DEPTH_TEST, true);
    instance_ = memnew(godot::MeshInstance3D);
    instance_->set_as_top_level(true);
    instance_->set_mesh(mesh_);
    instance_->set_material_override(material);
    instance_->set_cast_shadows_setting(godot::GeometryInstance3D::SHADOW_CASTING_SETTING_OFF);
    hand.add_child(instance_, false, godot::Node::INTERNAL_MODE_BACK);
}

void HandDrawing::line(const Vec3 &from_m, const Vec3 &to_m, const Color &colour) {
    mesh_->surface_set_color(colour);
    mesh_->surface_add_vertex(to_godot(frame_.point_to_world(from_m)));
    mesh_->surface_set_color(colour);
    mesh_->surface_add_vertex(to_godot(frame_.point_to_world(to_m)));
}

void HandDrawing::box(const Placement &at, const Vec3 &lower_m, const Vec3 &upper_m,
                      const Color &colour) {
    const Vec3 low = glm::clamp(lower_m, Vec3(-kLargest_m), Vec3(kLargest_m));
    const Vec3 high = glm::clamp(upper_m, Vec3(-kLargest_m), Vec3(kLargest_m));
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 from = low;
            from[(axis + 1) % 3] = (corner & 1) != 0 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
            from[(axis + 2) % 3] = (corner & 2) != 0 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
            Vec3 to = from;
            to[axis] = high[axis];
            line(at.origin_m + at.rotation * from, at.origin_m + at.rotation * to, colour);
        }
    }
}

void HandDrawing::tool(const ToolPose &pose, const Jaws &jaws, const Color &colour) {
    for (int side = 0; side < 2; ++side) {
        const Placement face = Pads::face(side, jaws, pose);
        for (int i = 0; i < kSectors; ++i) {
            const auto rim = [&face](int sector) {
                const double turn = 2.0 * std::numbers::pi * sector / kSectors;
                return face.origin_m + kPadRadius_m * (std::cos(turn) * face.rotation[1] +
                                                       std::sin(turn) * face.rotation[2]);
            };
            line(rim(i), rim(i + 1), colour);
        }
        line(pose.position_m, face.origin_m, colour);
    }
}

void HandDrawing::draw(godot::Node3D &hand, const WorldFrame &frame,
                       const std::vector<NearShape> &shapes, const TouchReport &touch,
                       const ToolPose &proxy, const ToolPose &device, const Jaws &jaws) {
    prepare(hand);
    frame_ = frame;
    mesh_->clear_surfaces();
    mesh_->surface_begin(godot::Mesh::PRIMITIVE_LINES);
    for (const NearShape &shape : shapes) {
        box(shape.at, shape.shape->lower_m(), shape.shape->upper_m(),
            (shape.seen_by & kSeenByPads) != 0 ? kPadsColour : kHeldColour);
    }
    tool(device, jaws, kDeviceColour);
    tool(proxy, jaws, kProxyColour);
    for (int i = 0; i < touch.point_count; ++i) {
        const TouchPointReport &point = touch.points[static_cast<std::size_t>(i)];
        line(point.point_m, point.point_m + kNormal_m * point.normal, kNormalColour);
        line(point.point_m, point.point_m + kForce_m_n * point.force_n, kForceColour);
    }
    mesh_->surface_end();
    shown_ = true;
}

void HandDrawing::hide() {
    if (shown_) {
        mesh_->clear_surfaces();
        shown_ = false;
    }
}

} // namespace spidar
