#include "godot/hand/hand_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/geometry_instance3d.hpp>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/shader.hpp>
#include <godot_cpp/classes/shader_material.hpp>
#include <godot_cpp/core/memory.hpp>
#include <godot_cpp/variant/vector2.hpp>

#include "device/contact/shapes/shape_outline.h"
#include "godot/base/type_conversions.h"
#include "godot/hand/pads.h"

namespace spidar {

namespace {

using godot::Color;

constexpr double kNormal_m = 0.004;
constexpr double kNormalRing_m = 0.002;
constexpr double kForce_m_n = 0.015;
constexpr double kLeastForce_n = 1e-3; // smallest force that gets an arrow
constexpr double kArrowHead = 0.25;    // of the arrow's length
constexpr double kLongestHead_m = 0.004;
constexpr double kBeyond_m = 0.03; // faces of meshes are drawn within this distance of the tool
constexpr int kSectors = 24;
// Alpha of meshes, so that contacts stay visible.
constexpr float kOfManyEdges = 0.4F;

// A line is a strip of two triangles: NORMAL is its direction, UV.x its side and UV.y its width.
// Thin lines are drawn slightly nearer to the eye than thick ones, and all of them nearer than the
// surfaces they lie on.
constexpr const char *kDepthTested = "depth_draw_never";
constexpr const char *kPaleOverAll = "depth_draw_never, depth_test_disabled";
std::string shader_code(const char *depth, const char *alpha) {
    return std::string("shader_type spatial;\n"
                       "render_mode unshaded, cull_disabled, shadows_disabled, fog_disabled, ") +
           depth + R"(;
void vertex() {
	vec4 place = MODELVIEW_MATRIX * vec4(VERTEX, 1.0);
	if (PROJECTION_MATRIX[3][3] < 0.5) { // a perspective
		place.xyz *= 1.0 - 0.006 / UV.y;
	}
	vec4 from = PROJECTION_MATRIX * place;
	vec4 by = PROJECTION_MATRIX * (MODELVIEW_MATRIX * vec4(NORMAL, 0.0));
	vec2 along = (by.xy * from.w - from.xy * by.w) * VIEWPORT_SIZE;
	float size = length(along);
	along = size > 0.0 ? along / size : vec2(1.0, 0.0);
	float width = UV.x * UV.y * max(1.0, VIEWPORT_SIZE.y / 720.0);
	POSITION = from;
	POSITION.xy += width * from.w * vec2(-along.y, along.x) / VIEWPORT_SIZE;
}
void fragment() {
	vec3 seen = COLOR.rgb;
	ALBEDO = OUTPUT_IS_SRGB ? seen : pow(seen, vec3(2.2));
	ALPHA = COLOR.a * )" +
           alpha + ";\n}\n";
}

godot::Ref<godot::ShaderMaterial> material_of(const char *depth, const char *alpha, int priority) {
    godot::Ref<godot::Shader> shader;
    shader.instantiate();
    shader->set_code(godot::String::utf8(shader_code(depth, alpha).c_str()));
    godot::Ref<godot::ShaderMaterial> material;
    material.instantiate();
    material->set_shader(shader);
    material->set_render_priority(priority);
    return material;
}

// Returns the distance from the grip center to the farthest point of the tool.
double reach_of(const HandPicture &picture) {
    double reach_m = 0.5 * picture.jaws.gap_m(picture.proxy.grasp_rad) +
                     pad_thickness_m(picture.jaws) + pad_radius_m(picture.jaws);
    for (const HeldShapes::Part &part : picture.held) {
        reach_m = std::max(reach_m, glm::length((picture.in_grip * part.box.at).origin_m) +
                                        glm::length(part.box.half_extents_m));
    }
    return reach_m;
}

} // namespace

const HandDrawing::Pen HandDrawing::kByPads{Color(0.30F, 0.65F, 1.0F), 1.2};
const HandDrawing::Pen HandDrawing::kByHeld{Color(1.0F, 0.55F, 0.10F), 1.2};
const HandDrawing::Pen HandDrawing::kProxy{Color(0.15F, 0.95F, 0.35F), 2.5};
const HandDrawing::Pen HandDrawing::kDevice{Color(1.0F, 1.0F, 1.0F), 1.5};
const HandDrawing::Pen HandDrawing::kForce{Color(1.0F, 0.10F, 0.60F), 3.5};
const HandDrawing::Pen HandDrawing::kNormal{Color(1.0F, 0.95F, 0.20F), 1.5};

void HandDrawing::prepare(godot::Node3D &hand) {
    if (instance_ != nullptr) {
        return;
    }
    constexpr int kLast = 127; // of all that is see-through
    mesh_.instantiate();
    const godot::Ref<godot::ShaderMaterial> pale = material_of(kPaleOverAll, "0.3", kLast - 1);
    pale->set_next_pass(material_of(kDepthTested, "1.0", kLast));
    instance_ = memnew(godot::MeshInstance3D);
    instance_->set_as_top_level(true);
    instance_->set_mesh(mesh_);
    instance_->set_material_override(pale);
    instance_->set_cast_shadows_setting(godot::GeometryInstance3D::SHADOW_CASTING_SETTING_OFF);
    hand.add_child(instance_, false, godot::Node::INTERNAL_MODE_BACK);
}

void HandDrawing::line(const Vec3 &from_m, const Vec3 &to_m, const Pen &pen) {
    const Vec3 from = frame_.point_to_world(from_m);
    const Vec3 to = frame_.point_to_world(to_m);
    const double length = glm::length(to - from);
    if (!(length > 0.0)) {
        return;
    }
    const godot::Vector3 along = to_godot((to - from) / length);
    struct Corner {
        const Vec3 &at;
        double side;
    };
    const std::array<Corner, 6> corners{
        {{from, -1.0}, {from, 1.0}, {to, 1.0}, {from, -1.0}, {to, 1.0}, {to, -1.0}}};
    for (const Corner &corner : corners) {
        mesh_->surface_set_color(pen.color);
        mesh_->surface_set_normal(along);
        mesh_->surface_set_uv(
            {static_cast<godot::real_t>(corner.side), static_cast<godot::real_t>(pen.width_px)});
        mesh_->surface_add_vertex(to_godot(corner.at));
    }
}

void HandDrawing::lines(const Placement &at, const std::vector<Vec3> &ends_m, const Pen &pen) {
    for (std::size_t i = 0; i + 1 < ends_m.size(); i += 2) {
        line(at.origin_m + at.rotation * ends_m[i], at.origin_m + at.rotation * ends_m[i + 1], pen);
    }
}

void HandDrawing::ring(const Placement &at, double radius_m, const Pen &pen) {
    const auto rim = [&](int sector) {
        const double turn = 2.0 * std::numbers::pi * sector / kSectors;
        return at.origin_m +
               radius_m * (std::cos(turn) * at.rotation[1] + std::sin(turn) * at.rotation[2]);
    };
    for (int i = 0; i < kSectors; ++i) {
        line(rim(i), rim(i + 1), pen);
    }
}

// The head has four sides, so that some are visible from anywhere.
void HandDrawing::arrow(const Vec3 &from_m, const Vec3 &along_m, const Pen &pen) {
    const double length = glm::length(along_m);
    const Vec3 ahead = along_m / length;
    const double head_m = std::min(kArrowHead * length, kLongestHead_m);
    const Vec3 u = 0.5 * head_m * any_across(ahead);
    const Vec3 v = glm::cross(ahead, u);
    const Vec3 tip_m = from_m + along_m;
    line(from_m, tip_m, pen);
    for (const Vec3 &side : {u, v, -u, -v}) {
        line(tip_m, tip_m - head_m * ahead + side, pen);
    }
}

void HandDrawing::shapes(const HandPicture &picture) {
    const double reach_m = reach_of(picture) + kBeyond_m;
    for (const NearShape &near : picture.shapes) {
        const Vec3 tool_m =
            glm::transpose(near.at.rotation) * (picture.proxy.position_m - near.at.origin_m);
        ends_m_.clear();
        add_outline(*near.shape, tool_m, reach_m, ends_m_);
        Pen pen = (near.seen_by & kSeenByPads) != 0 ? kByPads : kByHeld;
        pen.color.a = near.shape->convex() ? 1.0F : kOfManyEdges;
        lines(near.at, ends_m_, pen);
    }
}

// Draws both faces of each pad, and the line from the grip center to them.
void HandDrawing::tool(const ToolPose &pose, const Jaws &jaws, const Pen &pen) {
    for (int side = 0; side < 2; ++side) {
        const Placement inner = Pads::face(side, jaws, pose);
        const Placement outer{inner.origin_m + pad_thickness_m(jaws) * inner.rotation[0],
                              inner.rotation};
        ring(inner, pad_radius_m(jaws), pen);
        ring(outer, pad_radius_m(jaws), pen);
        line(pose.position_m, inner.origin_m, pen);
    }
}

void HandDrawing::points(const TouchReport &touch) {
    for (int i = 0; i < touch.point_count; ++i) {
        const TouchPointReport &point = touch.points[static_cast<std::size_t>(i)];
        if (glm::length(point.force_n) > kLeastForce_n) {
            arrow(point.point_m, kForce_m_n * point.force_n, kForce);
        }
        const Vec3 u = any_across(point.normal);
        ring({point.point_m, Mat3(point.normal, u, glm::cross(point.normal, u))}, kNormalRing_m,
             kNormal);
        line(point.point_m, point.point_m + kNormal_m * point.normal, kNormal);
    }
}

void HandDrawing::draw(godot::Node3D &hand, const HandPicture &picture) {
    prepare(hand);
    frame_ = picture.frame;
    mesh_->clear_surfaces();
    mesh_->surface_begin(godot::Mesh::PRIMITIVE_TRIANGLES);
    shapes(picture);
    tool(picture.proxy, picture.jaws, kProxy);
    for (const HeldShapes::Part &part : picture.held) {
        ends_m_.clear();
        add_box_outline(-part.box.half_extents_m, part.box.half_extents_m, ends_m_);
        const Placement grip{picture.proxy.position_m, picture.proxy.rotation};
        lines(grip * picture.in_grip * part.box.at, ends_m_, kProxy);
    }
    tool(picture.device, picture.jaws, kDevice);
    line(picture.device.position_m, picture.proxy.position_m, kDevice);
    points(picture.touch);
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
