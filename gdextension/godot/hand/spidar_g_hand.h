// SpidarGHand: the tool of a SPIDAR-G in a scene, two finger pads that touch, grasp and carry. In
// each physics tick it reads the servo loop's report on an earlier scene, decides what is held, and
// publishes the shapes near the tool, which the servo loop renders. Main thread only. The class
// reference is gdextension/doc_classes/SpidarGHand.xml.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>

#include "godot/base/strict.h"
#include "godot/device/spidar_g.h"
#include "godot/hand/body_pushes.h"
#include "godot/hand/device_clock.h"
#include "godot/hand/grasp/grasp_judge.h"
#include "godot/hand/grasp/held_joints.h"
#include "godot/hand/grasp/held_load.h"
#include "godot/hand/grasp/held_shapes.h"
#include "godot/hand/grasp/hold_joint.h"
#include "godot/hand/grasp/hold_watch.h"
#include "godot/hand/grasp/partner_ties.h"
#include "godot/hand/grasp/pinch.h"
#include "godot/hand/grasp/scene_joints.h"
#include "godot/hand/grasp/touched_bodies.h"
#include "godot/hand/hand_drawing.h"
#include "godot/hand/hand_place.h"
#include "godot/hand/pads.h"
#include "godot/hand/scene/surroundings.h"
#include "godot/hand/surface_news.h"
#include "godot/hand/touch_scenes.h"

// A number with setter and getter. The setter refuses a value outside m_least to m_most.
#define SPIDAR_G_HAND_NUMBER(m_name, m_default, m_least, m_most, m_unit)                           \
public:                                                                                            \
    void set_##m_name(double p_value) {                                                            \
        m_name##_ = checked_number(#m_name, p_value, m_name##_, m_least, m_most, m_unit);          \
    }                                                                                              \
    double get_##m_name() const {                                                                  \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    double m_name##_ = m_default

#define SPIDAR_G_HAND_FLAG(m_name, m_default)                                                      \
public:                                                                                            \
    void set_##m_name(bool p_value) {                                                              \
        m_name##_ = p_value;                                                                       \
    }                                                                                              \
    bool is_##m_name() const {                                                                     \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    bool m_name##_ = m_default

class SpidarGHand : public godot::Node3D {
    GDCLASS(SpidarGHand, godot::Node3D)
    SPIDAR_G_CHECKED_CALLS

    // Name, default, smallest and largest accepted value, unit.
    SPIDAR_G_HAND_NUMBER(contact_margin, 0.04, 0.001, 1.0, "m");
    SPIDAR_G_HAND_NUMBER(contact_stiffness, 0.0, 0.0, 1.0e4, "N/m");
    SPIDAR_G_HAND_NUMBER(contact_damping, 2.0, 0.0, 100.0, "N s/m");
    SPIDAR_G_HAND_NUMBER(contact_friction, 0.4, 0.0, 10.0, "");
    SPIDAR_G_HAND_NUMBER(pad_friction, 1.0, 0.0, 10.0, "");
    SPIDAR_G_HAND_NUMBER(hold_torque, 0.005, 0.0, 10.0, "N m");
    SPIDAR_G_HAND_NUMBER(break_force, 7.0, 0.0, 1000.0, "N");
    SPIDAR_G_HAND_NUMBER(weight_scale, 1.0, 0.0, 100.0, "");
    SPIDAR_G_HAND_FLAG(render_contacts, true);
    SPIDAR_G_HAND_FLAG(render_width, true);
    SPIDAR_G_HAND_FLAG(render_weight, true);
    SPIDAR_G_HAND_FLAG(render_inertia, true);

public:
    void set_collision_mask(std::int64_t mask);
    [[nodiscard]] std::int64_t get_collision_mask() const { return collision_mask_; }

    void set_debug_draw(bool wanted);
    [[nodiscard]] bool is_debug_draw() const { return debug_draw_; }

    // Reports a refused value or argument in the output.
    void refuse(const std::string &message) const;

    // The device and the held body.
    [[nodiscard]] SpidarG *get_spidar() const { return spidar_; }
    [[nodiscard]] godot::RigidBody3D *get_held_body() const { return hold_.body(); }
    [[nodiscard]] double get_held_width() const;
    [[nodiscard]] double get_held_weight() const { return told_.weight_n; }
    [[nodiscard]] godot::Transform3D get_wanted_pose() const;
    [[nodiscard]] double get_squeeze_torque() const { return squeeze_nm_; }
    [[nodiscard]] double get_stop_angle() const;
    void add_load(const godot::Vector3 &force_n, const godot::Vector3 &moment_nm);
    void detain(const godot::Transform3D &seat);
    void release();

    // Poses of the shown tool, in world coordinates.
    [[nodiscard]] godot::Transform3D get_proxy_transform() const;
    [[nodiscard]] godot::Transform3D get_pad_transform(int side) const;
    [[nodiscard]] godot::Vector3 get_pad_position(int side) const;
    [[nodiscard]] double get_pad_radius() const;

    // What the tool can touch and touches.
    [[nodiscard]] godot::Array get_shapes_in_reach() const;
    [[nodiscard]] godot::Array get_touch_points() const;
    [[nodiscard]] godot::Dictionary get_touch_statistics() const;

    void _enter_tree() override;
    void _ready() override;
    void _exit_tree() override;
    void _physics_process(double delta) override;
    [[nodiscard]] godot::PackedStringArray _get_configuration_warnings() const override;
    [[nodiscard]] godot::PackedStringArray get_warnings() const {
        return _get_configuration_warnings();
    }

protected:
    static void _bind_methods();

private:
    static void bind_properties();
    // Returns `value`, or `old` with an error when `value` is not between `least` and `most`.
    [[nodiscard]] double checked_number(const char *name, double value, double old, double least,
                                        double most, const char *unit) const;

    // Steps of a physics tick (spidar_g_hand_tick.cpp).
    void read_device(double since_s);
    void watch_pinch(double since_s);
    void watch_hold();
    void try_grasp();
    void attach(godot::RigidBody3D &body);
    void carry(double delta_s);
    void push_bodies(double since_s);
    // Returns the held body's target: the mean of `mine`, this hand's own target, and those of the
    // other hands that hold the body.
    [[nodiscard]] godot::Transform3D agree_on(const godot::Transform3D &mine);
    void add_joints(spidar::Tool &tool);
    void remember_place();
    void tell_held();
    void note_node(godot::Node *node);

    // Publishing (spidar_g_hand_scene.cpp).
    void gather();
    void publish();
    void withdraw();
    void draw();
    [[nodiscard]] spidar::SearchVolume pads_volume() const;
    [[nodiscard]] spidar::SearchVolume held_volume() const;
    void look_at_held();
    [[nodiscard]] spidar::HeldLoad::Pull load_of_held() const;
    [[nodiscard]] spidar::HandFeel feel() const;
    [[nodiscard]] spidar::Placement held_in_grip() const;

    [[nodiscard]] spidar::Jaws jaws() const;
    [[nodiscard]] spidar::ToolPose device_pose() const;
    // Pose of the proxy, which stops at surfaces, in the device frame. Without a scene: the
    // device's pose.
    [[nodiscard]] spidar::ToolPose proxy_pose() const;
    // Pose of the shown tool in the world: at the held body, else at the proxy.
    [[nodiscard]] godot::Transform3D shown_grip() const;
    [[nodiscard]] bool is_open() const;
    [[nodiscard]] const spidar::WorldFrame &stepped() const { return stepped_ ? *stepped_ : now_; }

    std::int64_t collision_mask_ = 1;

    SpidarG *spidar_ = nullptr;
    spidar::HandPlace place_;
    bool acts_ = false;
    spidar::DeviceClock clock_;
    spidar::WorldFrame now_;                    // of the device's node in this tick
    std::optional<spidar::WorldFrame> stepped_; // at the last physics step
    spidar::Pads pads_;
    spidar::Surroundings surroundings_;
    spidar::TouchedBodies touched_;
    spidar::BodyPushes pushes_;
    spidar::SurfaceNews news_;

    spidar::Pinch pinch_;
    double pinch_age_s_ = 0.0; // time since the pads last pressed a body
    double resting_s_ = 0.0;   // time for which the pinched width has hardly changed
    double squeeze_nm_ = 0.0;
    spidar::GraspJudge judge_;

    spidar::HoldJoint hold_;
    spidar::HoldWatch watch_;
    spidar::HeldShapes held_shapes_;
    spidar::SceneJoints scene_joints_;
    spidar::HeldJoints held_joints_;
    spidar::PartnerTies partners_;
    spidar::HeldLoad load_;
    spidar::HeldLoad::Body held_;
    double held_stop_rad_ = 0.0;
    double held_squeeze_nm_rad_ = 0.0;

    enum class Published { nothing, empty, scene };
    Published published_ = Published::nothing;
    spidar::Jaws published_jaws_;
    spidar::HeldLoad::Pull pull_; // as published in the last scene
    struct HeldFeel {
        double weight_n = 0.0;
        double width_m = 0.0;
        double squeeze_nm = 0.0;
    };
    HeldFeel told_;
    std::uint64_t seen_sequence_ = 0;
    bool debug_draw_ = false;
    spidar::HandDrawing drawing_;
};
