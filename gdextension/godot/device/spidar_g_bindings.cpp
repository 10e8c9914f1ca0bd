// The names for GDScript, in the order of the inspector.
#include "godot/device/spidar_g.h"

using godot::ClassDB;
using godot::D_METHOD;
using godot::MethodInfo;
using godot::PropertyInfo;
using godot::Variant;

// Godot's enums have the numbers of the core's.
static_assert(static_cast<int>(spidar::DeviceState::calibrated) == SpidarG::STATE_CALIBRATED);
static_assert(static_cast<int>(spidar::GraspPhase::over_closed) == SpidarG::GRASP_OVER_CLOSED);
static_assert(static_cast<int>(spidar::ContactTarget::turn_stop) == SpidarG::CONTACT_TURN_STOP);
static_assert(static_cast<int>(spidar::kAllDof) == SpidarG::DOF_ALL);
static_assert(static_cast<int>(spidar::HandFirmness::firm) == SpidarG::HAND_FIRM);
static_assert(static_cast<int>(spidar::SimulatedFault::blocked_output) ==
              SpidarG::FAULT_BLOCKED_OUTPUT);

void SpidarG::_bind_methods() {
    bind_enums();
    bind_setup();
    bind_state();
    bind_requests();
    bind_effects();
    bind_recording();
    bind_simulated();
    bind_device();
}

void SpidarG::bind_setup() {
    spidar::bind_checked<&SpidarG::set_config, "", "set_config", "config">();
    ClassDB::bind_method(D_METHOD("get_config"), &SpidarG::get_config);
    ClassDB::bind_method(D_METHOD("get_warnings"), &SpidarG::get_warnings);
    ClassDB::bind_method(D_METHOD("get_effective_config"), &SpidarG::get_effective_config);
    spidar::bind_checked<&SpidarG::set_calibration, "", "set_calibration", "calibration">();
    ClassDB::bind_method(D_METHOD("get_calibration"), &SpidarG::get_calibration);
    spidar::bind_checked<&SpidarG::set_enabled, "", "set_enabled", "enabled">();
    ClassDB::bind_method(D_METHOD("is_enabled"), &SpidarG::is_enabled);
    spidar::bind_checked<&SpidarG::set_forces_enabled, "", "set_forces_enabled", "enabled">();
    ClassDB::bind_method(D_METHOD("are_forces_enabled"), &SpidarG::are_forces_enabled);
    spidar::bind_checked<&SpidarG::set_drive_mode, "", "set_drive_mode", "mode">();
    ClassDB::bind_method(D_METHOD("get_drive_mode"), &SpidarG::get_drive_mode);
    spidar::bind_checked<&SpidarG::set_workspace_scale, "", "set_workspace_scale", "scale">();
    ClassDB::bind_method(D_METHOD("get_workspace_scale"), &SpidarG::get_workspace_scale);

    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "config", godot::PROPERTY_HINT_RESOURCE_TYPE,
                              "SpidarGConfig"),
                 "set_config", "get_config");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "calibration", godot::PROPERTY_HINT_RESOURCE_TYPE,
                              "SpidarGCalibration"),
                 "set_calibration", "get_calibration");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "enabled"), "set_enabled", "is_enabled");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "forces_enabled"), "set_forces_enabled",
                 "are_forces_enabled");
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "drive_mode", godot::PROPERTY_HINT_ENUM, "Threaded,Stepped"),
        "set_drive_mode", "get_drive_mode");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "workspace_scale", godot::PROPERTY_HINT_RANGE,
                              "0.1,100,0.001,or_less,or_greater"),
                 "set_workspace_scale", "get_workspace_scale");

    ClassDB::bind_method(D_METHOD("arm"), &SpidarG::arm);
    ClassDB::bind_method(D_METHOD("disarm"), &SpidarG::disarm);
    ClassDB::bind_method(D_METHOD("panic_stop"), &SpidarG::panic_stop);
    ClassDB::bind_method(D_METHOD("zero_at_home"), &SpidarG::zero_at_home);
    spidar::bind_checked<&SpidarG::set_release_on_focus_loss, "", "set_release_on_focus_loss",
                         "release">();
    ClassDB::bind_method(D_METHOD("is_release_on_focus_loss"), &SpidarG::is_release_on_focus_loss);
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "release_on_focus_loss"), "set_release_on_focus_loss",
                 "is_release_on_focus_loss");
    ClassDB::bind_method(D_METHOD("clear_fault"), &SpidarG::clear_fault);
    spidar::bind_checked<&SpidarG::advance_cycles, "", "advance_cycles", "cycles">();

    ADD_SIGNAL(MethodInfo("device_connected"));
    ADD_SIGNAL(MethodInfo("device_lost", PropertyInfo(Variant::STRING, "reason")));
    ADD_SIGNAL(MethodInfo("armed"));
    ADD_SIGNAL(MethodInfo("disarmed"));
    ADD_SIGNAL(MethodInfo("device_event", PropertyInfo(Variant::DICTIONARY, "event")));
    ADD_SIGNAL(MethodInfo("fault_raised", PropertyInfo(Variant::INT, "status"),
                          PropertyInfo(Variant::STRING, "message")));
    ADD_SIGNAL(MethodInfo("grasped"));
    ADD_SIGNAL(MethodInfo("released"));
    ADD_SIGNAL(MethodInfo("over_closed"));
    ADD_SIGNAL(MethodInfo("tension_saturated"));
    ADD_SIGNAL(MethodInfo("request_rejected", PropertyInfo(Variant::STRING, "message")));
}

void SpidarG::bind_state() {
    ClassDB::bind_method(D_METHOD("get_state"), &SpidarG::get_state);
    ClassDB::bind_method(D_METHOD("get_state_text"), &SpidarG::get_state_text);
    ClassDB::bind_method(D_METHOD("get_fault_text"), &SpidarG::get_fault_text);
    ClassDB::bind_method(D_METHOD("get_device_time"), &SpidarG::get_device_time);
    ClassDB::bind_method(D_METHOD("_note_place"), &SpidarG::note_place); // called deferred
    ClassDB::bind_method(D_METHOD("get_grip_transform"), &SpidarG::get_grip_transform);
    spidar::bind_checked<&SpidarG::get_pole_transform, "", "get_pole_transform", "pole">();
    spidar::bind_checked<&SpidarG::get_pole_end, "", "get_pole_end", "target">();
    spidar::bind_checked<&SpidarG::get_string_start, "", "get_string_start", "string">();
    spidar::bind_checked<&SpidarG::get_string_end, "", "get_string_end", "string">();
    ClassDB::bind_method(D_METHOD("get_grasp_angle"), &SpidarG::get_grasp_angle);
    ClassDB::bind_method(D_METHOD("get_grasp_rate"), &SpidarG::get_grasp_rate);
    ClassDB::bind_method(D_METHOD("get_grasp_phase"), &SpidarG::get_grasp_phase);
    ClassDB::bind_method(D_METHOD("get_jaw_gap"), &SpidarG::get_jaw_gap);
    spidar::bind_checked<&SpidarG::get_grasp_angle_for_gap, "", "get_grasp_angle_for_gap",
                         "gap_m">();
    ClassDB::bind_method(D_METHOD("get_linear_velocity"), &SpidarG::get_linear_velocity);
    ClassDB::bind_method(D_METHOD("get_angular_velocity"), &SpidarG::get_angular_velocity);
    ClassDB::bind_method(D_METHOD("get_string_lengths"), &SpidarG::get_string_lengths);
    ClassDB::bind_method(D_METHOD("get_string_tensions"), &SpidarG::get_string_tensions);
    ClassDB::bind_method(D_METHOD("get_encoder_counts"), &SpidarG::get_encoder_counts);
    ClassDB::bind_method(D_METHOD("get_requested_wrench"), &SpidarG::get_requested_wrench);
    ClassDB::bind_method(D_METHOD("get_achieved_wrench"), &SpidarG::get_achieved_wrench);
    ClassDB::bind_method(D_METHOD("get_wrench_bias"), &SpidarG::get_wrench_bias);
    ClassDB::bind_method(D_METHOD("get_statistics"), &SpidarG::get_statistics);
    ClassDB::bind_method(D_METHOD("get_lateness_histogram"), &SpidarG::get_lateness_histogram);
}

void SpidarG::bind_requests() {
    const godot::String script; // the owner when a script names none
    spidar::bind_checked<&SpidarG::request_wrench, "", "request_wrench", "force", "moment",
                         "grasp_torque", "duration_s", "owner">(0.05, script);
    spidar::bind_checked<&SpidarG::set_contacts, "", "set_contacts", "contacts", "owner">(script);
    spidar::bind_checked<&SpidarG::clear_contacts, "", "clear_contacts", "owner">(script);
    spidar::bind_checked<&SpidarG::get_free_contacts, "", "get_free_contacts", "owner">(script);
    spidar::bind_checked<&SpidarG::get_contact_impulses, "", "get_contact_impulses", "owner">(
        script);
    spidar::bind_checked<&SpidarG::get_touching_contacts, "", "get_touching_contacts", "owner">(
        script);
}

void SpidarG::bind_recording() {
    spidar::bind_checked<&SpidarG::start_recording, "", "start_recording", "path">();
    ClassDB::bind_method(D_METHOD("stop_recording"), &SpidarG::stop_recording);
    ClassDB::bind_method(D_METHOD("is_recording"), &SpidarG::is_recording);
    ClassDB::bind_method(D_METHOD("get_recording_statistics"), &SpidarG::get_recording_statistics);
    spidar::bind_checked<&SpidarG::start_replay, "", "start_replay", "path">();
    ClassDB::bind_method(D_METHOD("stop_replay"), &SpidarG::stop_replay);
    ClassDB::bind_method(D_METHOD("is_replaying"), &SpidarG::is_replaying);
    ClassDB::bind_method(D_METHOD("get_replay_statistics"), &SpidarG::get_replay_statistics);
    ADD_SIGNAL(MethodInfo("recording_failed", PropertyInfo(Variant::STRING, "message")));
    ADD_SIGNAL(MethodInfo("replay_finished", PropertyInfo(Variant::BOOL, "identical"),
                          PropertyInfo(Variant::STRING, "message")));
}

void SpidarG::bind_simulated() {
    spidar::bind_checked<&SpidarG::set_simulated_hand_target, "", "set_simulated_hand_target",
                         "target", "grasp_angle">();
    spidar::bind_checked<&SpidarG::set_simulated_hand_firmness, "", "set_simulated_hand_firmness",
                         "firmness">();
    ClassDB::bind_method(D_METHOD("get_simulated_truth"), &SpidarG::get_simulated_truth);
#ifdef DEBUG_ENABLED
    spidar::bind_checked<&SpidarG::inject_simulated_fault, "", "inject_simulated_fault", "fault",
                         "string", "start_s", "duration_s">(0, 0.0, 0.0);
    ClassDB::bind_method(D_METHOD("clear_simulated_faults"), &SpidarG::clear_simulated_faults);
#endif
}

void SpidarG::bind_enums() {
    BIND_ENUM_CONSTANT(DRIVE_THREADED);
    BIND_ENUM_CONSTANT(DRIVE_STEPPED);
    BIND_ENUM_CONSTANT(STATE_CLOSED);
    BIND_ENUM_CONSTANT(STATE_CONNECTED);
    BIND_ENUM_CONSTANT(STATE_ARMING);
    BIND_ENUM_CONSTANT(STATE_ACTIVE);
    BIND_ENUM_CONSTANT(STATE_FADING);
    BIND_ENUM_CONSTANT(STATE_FAULT);
    BIND_ENUM_CONSTANT(STATE_TAUT);
    BIND_ENUM_CONSTANT(STATE_CALIBRATED);
    BIND_ENUM_CONSTANT(EVENT_INFO);
    BIND_ENUM_CONSTANT(EVENT_WARNING);
    BIND_ENUM_CONSTANT(EVENT_FAULT);
    BIND_ENUM_CONSTANT(GRASP_OPEN);
    BIND_ENUM_CONSTANT(GRASP_GRASPED);
    BIND_ENUM_CONSTANT(GRASP_OVER_CLOSED);
    BIND_ENUM_CONSTANT(CONTACT_CENTER);
    BIND_ENUM_CONSTANT(CONTACT_POLE1_PLUS);
    BIND_ENUM_CONSTANT(CONTACT_POLE1_MINUS);
    BIND_ENUM_CONSTANT(CONTACT_POLE2_PLUS);
    BIND_ENUM_CONSTANT(CONTACT_POLE2_MINUS);
    BIND_ENUM_CONSTANT(CONTACT_GRASP_STOP);
    BIND_ENUM_CONSTANT(CONTACT_TURN_STOP);
    BIND_ENUM_CONSTANT(DOF_X);
    BIND_ENUM_CONSTANT(DOF_Y);
    BIND_ENUM_CONSTANT(DOF_Z);
    BIND_ENUM_CONSTANT(DOF_LINEAR);
    BIND_ENUM_CONSTANT(DOF_TURN_X);
    BIND_ENUM_CONSTANT(DOF_TURN_Y);
    BIND_ENUM_CONSTANT(DOF_TURN_Z);
    BIND_ENUM_CONSTANT(DOF_ANGULAR);
    BIND_ENUM_CONSTANT(DOF_GRASP);
    BIND_ENUM_CONSTANT(DOF_ALL);
    BIND_ENUM_CONSTANT(HAND_LIGHT);
    BIND_ENUM_CONSTANT(HAND_NORMAL);
    BIND_ENUM_CONSTANT(HAND_FIRM);
    BIND_ENUM_CONSTANT(FAULT_OUTPUT_CUT);
    BIND_ENUM_CONSTANT(FAULT_FROZEN_COUNTS);
    BIND_ENUM_CONSTANT(FAULT_COUNT_JUMP);
    BIND_ENUM_CONSTANT(FAULT_READ_TIMEOUT);
    BIND_ENUM_CONSTANT(FAULT_UNPLUGGED);
    BIND_ENUM_CONSTANT(FAULT_STUCK_ENCODER);
    BIND_ENUM_CONSTANT(FAULT_BROKEN_STRING);
    BIND_ENUM_CONSTANT(FAULT_HAND_RELEASED);
    BIND_ENUM_CONSTANT(FAULT_JAMMED_DRUM);
    BIND_ENUM_CONSTANT(FAULT_SLIPPED_STRING);
    BIND_ENUM_CONSTANT(FAULT_COUNTS_RESET);
    BIND_ENUM_CONSTANT(FAULT_REVERSED_ENCODER);
    BIND_ENUM_CONSTANT(FAULT_SWAPPED_ENCODERS);
    BIND_ENUM_CONSTANT(FAULT_REPORTS_LOST);
    BIND_ENUM_CONSTANT(FAULT_REPORTS_REPEATED);
    BIND_ENUM_CONSTANT(FAULT_REPORTS_SWAPPED);
    BIND_ENUM_CONSTANT(FAULT_LATE_OUTPUT);
    BIND_ENUM_CONSTANT(FAULT_BLOCKED_OUTPUT);
    BIND_CONSTANT(CONTACT_STRIDE);
}

void SpidarG::bind_device() {
    ClassDB::bind_method(D_METHOD("zero_device"), &SpidarG::zero_device);
    ClassDB::bind_method(D_METHOD("get_device_info"), &SpidarG::get_device_info);
    ClassDB::bind_method(D_METHOD("is_simulated"), &SpidarG::is_simulated);
    ClassDB::bind_method(D_METHOD("get_device_text"), &SpidarG::get_device_text);
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "device_text", godot::PROPERTY_HINT_NONE, "",
                              godot::PROPERTY_USAGE_EDITOR | godot::PROPERTY_USAGE_READ_ONLY),
                 "", "get_device_text");
    ClassDB::bind_static_method(get_class_static(), D_METHOD("list_devices"),
                                &SpidarG::list_devices);
    ADD_SIGNAL(MethodInfo("device_chosen", PropertyInfo(Variant::BOOL, "simulated"),
                          PropertyInfo(Variant::STRING, "device"),
                          PropertyInfo(Variant::STRING, "reason")));
    spidar::bind_checked<&SpidarG::set_simulated_buttons, "", "set_simulated_buttons", "mask">();
    ADD_SIGNAL(MethodInfo("button_changed", PropertyInfo(Variant::INT, "button"),
                          PropertyInfo(Variant::BOOL, "pressed")));
}
