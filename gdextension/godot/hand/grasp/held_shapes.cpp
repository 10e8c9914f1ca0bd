#include "godot/hand/grasp/held_shapes.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/scene/near_body.h"

namespace spidar {

namespace {

// Cooks the hull of a shape that is not convex.
CookResult cook_hull(const ShapeNumbers &numbers, const Vec3 &scale) {
    ShapeDescription hull = describe(numbers, scale);
    hull.kind = ShapeKind::hull;
    return cook(std::move(hull));
}

} // namespace

void HeldShapes::take(godot::RigidBody3D &body, double workspace_scale) {
    drop();
    auto *const server = godot::PhysicsServer3D::get_singleton();
    const godot::RID rid = body.get_rid();
    const int count = server->body_get_shape_count(rid);
    std::vector<bool> disabled(static_cast<std::size_t>(count), false);
    for_owned_shapes(body, [&disabled](std::uint32_t, std::size_t index, bool is_disabled) {
        if (index < disabled.size()) {
            disabled[index] = is_disabled;
        }
    });
    const Mat3 axes = to_core(body.get_global_transform().basis);
    const Mat3 back = glm::transpose(to_core(body.get_global_transform().basis.orthonormalized()));
    shelf_.begin_tick();
    for (int i = 0; i < count; ++i) {
        const godot::Transform3D local = server->body_get_shape_transform(rid, i);
        const TurnAndScale apart = take_apart(axes * to_core(local.basis));
        if (disabled[static_cast<std::size_t>(i)] || apart.sheared) {
            continue;
        }
        const Vec3 origin = back * (axes * to_core(local.origin));
        waiting_.push_back({shelf_.find(server->body_get_shape(rid, i)),
                            {origin / workspace_scale, back * apart.turn},
                            apart.scale / workspace_scale});
    }
    update();
}

void HeldShapes::update() {
    shelf_.begin_tick();
    const auto done = [this](const Waiting &one) { return ready(one); };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), done), waiting_.end());
}

bool HeldShapes::ready(const Waiting &one) {
    const Piece &piece = shelf_.cooked(*one.source, one.scale);
    if (piece.state == PieceState::cooking) {
        return false;
    }
    if (piece.shape == nullptr) {
        return true; // not rendered; the gatherer reported why
    }
    if (piece.shape->convex()) {
        add(*piece.shape, one.in_body);
    } else if (piece.shape->kind() == ShapeKind::mesh) {
        const CookResult hull = cook_hull(one.source->data.numbers, one.scale);
        if (hull.shape != nullptr) {
            add(*hull.shape, one.in_body);
        }
    }
    return true;
}

void HeldShapes::add(const CookedShape &shape, const Placement &in_body) {
    const ToolResult made = make_tool(shape);
    if (made.tool == nullptr) {
        return;
    }
    Part part;
    part.shape = made.tool;
    part.in_body = in_body;
    part.box.half_extents_m = 0.5 * (shape.upper_m() - shape.lower_m());
    part.box.at = in_body * Placement{0.5 * (shape.upper_m() + shape.lower_m()), Mat3(1.0)};
    parts_.push_back(part);
    Vec3 lower(1e9);
    Vec3 upper(-1e9);
    for (const Part &one : parts_) {
        Vec3 reach(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            reach += glm::abs(one.box.at.rotation[axis]) * one.box.half_extents_m[axis];
        }
        lower = glm::min(lower, one.box.at.origin_m - reach);
        upper = glm::max(upper, one.box.at.origin_m + reach);
    }
    box_.at.origin_m = 0.5 * (lower + upper);
    box_.half_extents_m = 0.5 * (upper - lower);
}

void HeldShapes::drop() {
    waiting_.clear();
    parts_.clear();
    box_ = TurnedBox();
}

} // namespace spidar
