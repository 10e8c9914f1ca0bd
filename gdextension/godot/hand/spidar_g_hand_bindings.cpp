// The names of SpidarGHand for Godot.
#include "godot/hand/spidar_g_hand.h"

#include "godot/base/resource_field.h"

using godot::ClassDB;
using godot::D_METHOD;
using godot::MethodInfo;
using godot::PropertyInfo;
using godot::Variant;
using Self = SpidarGHand;

#define BIND_NUMBER(m_name, m_hint)                                                                \
    SPIDAR_G_BIND_FIELD(SpidarGHand, Variant::FLOAT, m_name, godot::PROPERTY_HINT_RANGE, m_hint)
#define BIND_FLAG(m_name)                                                                          \
    spidar::bind_checked<&Self::set_##m_name, "", "set_" #m_name, #m_name>();                      \
    ClassDB::bind_method(D_METHOD("is_" #m_name), &Self::is_##m_name);                             \
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, #m_name), "set_" #m_name, "is_" #m_name)

void SpidarGHand::bind_properties() {
    spidar::bind_checked<&Self::set_collision_mask, "", "set_collision_mask", "mask">();
    ClassDB::bind_method(D_METHOD("get_collision_mask"), &Self::get_collision_mask);
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "collision_mask", godot::PROPERTY_HINT_LAYERS_3D_PHYSICS),
        "set_collision_mask", "get_collision_mask");
    ADD_GROUP("Contact", "contact_");
    BIND_NUMBER(contact_margin, "0.001,0.1,0.001,or_greater,suffix:m");
    BIND_NUMBER(contact_stiffness, "0,2000,1,or_greater,suffix:N/m");
    BIND_NUMBER(contact_damping, "0,5,0.1,or_greater,suffix:N s/m");
    BIND_NUMBER(contact_friction, "0,2,0.01,or_greater");
    ADD_GROUP("Grasp", "");
    BIND_NUMBER(pad_friction, "0,2,0.01,or_greater");
    BIND_NUMBER(hold_torque, "0,0.4,0.001,or_greater,suffix:N m");
    BIND_NUMBER(break_force, "0,50,0.1,or_greater,suffix:N");
    ADD_GROUP("Feel", "");
    BIND_FLAG(render_contacts);
    BIND_FLAG(render_width);
    BIND_FLAG(render_weight);
    BIND_FLAG(render_inertia);
    BIND_NUMBER(weight_scale, "0,2,0.01,or_greater");
    ADD_GROUP("Debug", "debug_");
    BIND_FLAG(debug_draw);
}

void SpidarGHand::_bind_methods() {
    bind_properties();
    ClassDB::bind_method(D_METHOD("get_spidar"), &Self::get_spidar);
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "spidar", godot::PROPERTY_HINT_NONE, "",
                              godot::PROPERTY_USAGE_NONE, "SpidarG"),
                 "", "get_spidar");
    ClassDB::bind_method(D_METHOD("get_warnings"), &Self::get_warnings);
    ClassDB::bind_method(D_METHOD("get_held_body"), &Self::get_held_body);
    ClassDB::bind_method(D_METHOD("get_held_width"), &Self::get_held_width);
    ClassDB::bind_method(D_METHOD("get_held_weight"), &Self::get_held_weight);
    ClassDB::bind_method(D_METHOD("get_wanted_pose"), &Self::get_wanted_pose);
    ClassDB::bind_method(D_METHOD("get_squeeze_torque"), &Self::get_squeeze_torque);
    ClassDB::bind_method(D_METHOD("get_stop_angle"), &Self::get_stop_angle);
    spidar::bind_checked<&Self::add_load, "", "add_load", "force_n", "moment_nm">(godot::Vector3());
    spidar::bind_checked<&Self::detain, "", "detain", "seat">();
    ClassDB::bind_method(D_METHOD("release"), &Self::release);
    ClassDB::bind_method(D_METHOD("get_proxy_transform"), &Self::get_proxy_transform);
    spidar::bind_checked<&Self::get_pad_transform, "", "get_pad_transform", "side">();
    spidar::bind_checked<&Self::get_pad_position, "", "get_pad_position", "side">();
    ClassDB::bind_method(D_METHOD("get_pad_radius"), &Self::get_pad_radius);
    ClassDB::bind_method(D_METHOD("get_shapes_in_reach"), &Self::get_shapes_in_reach);
    ClassDB::bind_method(D_METHOD("get_touch_points"), &Self::get_touch_points);
    ClassDB::bind_method(D_METHOD("get_touch_statistics"), &Self::get_touch_statistics);
    ClassDB::bind_method(D_METHOD("_remember_place"), &Self::remember_place); // called deferred

    const PropertyInfo body(Variant::OBJECT, "body", godot::PROPERTY_HINT_RESOURCE_TYPE,
                            "RigidBody3D");
    ADD_SIGNAL(MethodInfo("body_grasped", body));
    ADD_SIGNAL(MethodInfo("body_released", body));
    ADD_SIGNAL(MethodInfo("grasp_refused", body, PropertyInfo(Variant::STRING, "reason")));
    ADD_SIGNAL(MethodInfo("hold_changed", PropertyInfo(Variant::FLOAT, "weight"),
                          PropertyInfo(Variant::FLOAT, "width"),
                          PropertyInfo(Variant::FLOAT, "squeeze")));
    ADD_SIGNAL(MethodInfo("carrying", PropertyInfo(Variant::FLOAT, "delta")));
}
