#include "godot/hand/scene/engine_habits.h"

#include <godot_cpp/classes/physics_direct_space_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/physics_shape_query_parameters3d.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/plane.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/string.hpp>

namespace spidar {

namespace {

using godot::PhysicsServer3D;

// Tests, in a space of its own, whether the origin lies inside a boundary that is solid up to 1 m
// above it.
bool turns_boundaries() {
    auto *server = PhysicsServer3D::get_singleton();
    const godot::RID space = server->space_create();
    const godot::RID wall = server->world_boundary_shape_create();
    const godot::RID box = server->box_shape_create();
    const godot::RID body = server->body_create();
    server->shape_set_data(wall, godot::Plane(godot::Vector3(0, 1, 0), 1));
    server->shape_set_data(box, godot::Vector3(0.1F, 0.1F, 0.1F));
    server->body_set_mode(body, PhysicsServer3D::BODY_MODE_STATIC);
    server->body_add_shape(body, wall, godot::Transform3D());
    server->space_set_active(space, true);
    server->body_set_space(body, space);
    bool turned = false;
    if (auto *state = server->space_get_direct_state(space)) {
        godot::Ref<godot::PhysicsShapeQueryParameters3D> query;
        query.instantiate();
        query->set_shape_rid(box);
        turned = godot::Array(state->intersect_shape(query, 1)).is_empty();
    }
    for (const godot::RID &made : {body, box, wall, space}) {
        server->free_rid(made);
    }
    return turned;
}

} // namespace

const EngineHabits &engine_habits() {
    static const EngineHabits habits = [] {
        const godot::String engine(godot::ProjectSettings::get_singleton()->get_setting(
            "physics/3d/physics_engine", godot::Variant()));
        return EngineHabits{engine == "Jolt Physics", turns_boundaries()};
    }();
    return habits;
}

} // namespace spidar
