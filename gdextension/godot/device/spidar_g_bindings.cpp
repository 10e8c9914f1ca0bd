// The names GDScript sees. Order here is the order of the inspector.
#include "godot/device/spidar_g.h"

using godot::ClassDB;
using godot::D_METHOD;
using godot::MethodInfo;
using godot::PropertyInfo;
using godot::Variant;

// Godot's enums are the core's, number for number.
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
    ClassDB::bind_method(D_METHOD("set_config", "config"), &SpidarG::set_config);
    ClassDB::bind_method(D_METHOD("get_config"), &SpidarG::get_config);
    ClassDB::bind_method(D_METHOD("set_calibration", "calibration"), &SpidarG::set_calibration);
    ClassDB::bind_method(D_METHOD("get_calibration"), &SpidarG::get_calibration);
    ClassDB::bind_method(D_METHOD("set_enabled", "enabled"), &SpidarG::set_enabled);
    ClassDB::bind_method(D_METHOD("is_enabled"), &SpidarG::is_enabled);
    ClassDB::bind_method(D_METHOD("set_forces_enabled", "enabled"), &SpidarG::set_forces_enabled);
    ClassDB::bind_method(D_METHOD("are_forces_enabled"), &SpidarG::are_forces_enabled);
    ClassDB::bind_method(D_METHOD("set_drive_mode", "mode"), &SpidarG::set_drive_mode);
    ClassDB::bind_method(D_METHOD("get_drive_mode"), &SpidarG::get_drive_mode);
    ClassDB::bind_method(D_METHOD("set_workspace_scale", "scale"), &SpidarG::set_workspace_scale);
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
                              "0.1,100,0.01,or_greater"),
                 "set_workspace_scale", "get_workspace_scale");

    ClassDB::bind_method(D_METHOD("arm"), &SpidarG::arm);
    ClassDB::bind_method(D_METHOD("disarm"), &SpidarG::disarm);
    ClassDB::bind_method(D_METHOD("panic_stop"), &SpidarG::panic_stop);
    ClassDB::bind_method(D_METHOD("zero_at_home"), &SpidarG::zero_at_home);
    ClassDB::bind_method(D_METHOD("set_release_on_focus_loss", "release"),
                         &SpidarG::set_release_on_focus_loss);
    ClassDB::bind_method(D_METHOD("is_release_on_focus_loss"), &SpidarG::is_release_on_focus_loss);
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "release_on_focus_loss"), "set_release_on_focus_loss",
                 "is_release_on_focus_loss");
    ClassDB::bind_method(D_METHOD("clear_fault"), &SpidarG::clear_fault);
    ClassDB::bind_method(D_METHOD("advance_cycles", "cycles"), &SpidarG::advance_cycles);

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
    ClassDB::bind_method(D_METHOD("get_grip_transform"), &SpidarG::get_grip_transform);
    ClassDB::bind_method(D_METHOD("get_pole_transform", "pole"), &SpidarG::get_pole_transform);
    ClassDB::bind_method(D_METHOD("get_pole_end", "target"), &SpidarG::get_pole_end);
    ClassDB::bind_method(D_METHOD("get_string_start", "string"), &SpidarG::get_string_start);
    ClassDB::bind_method(D_METHOD("get_string_end", "string"), &SpidarG::get_string_end);
    ClassDB::bind_method(D_METHOD("get_grasp_angle"), &SpidarG::get_grasp_angle);
    ClassDB::bind_method(D_METHOD("get_grasp_rate"), &SpidarG::get_grasp_rate);
    ClassDB::bind_method(D_METHOD("get_grasp_phase"), &SpidarG::get_grasp_phase);
    ClassDB::bind_method(D_METHOD("get_jaw_gap"), &SpidarG::get_jaw_gap);
    ClassDB::bind_method(D_METHOD("get_grasp_angle_for_gap", "gap_m"),
                         &SpidarG::get_grasp_angle_for_gap);
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
    ClassDB::bind_method(
        D_METHOD("request_wrench", "force", "moment", "grasp_torque", "duration_s"),
        &SpidarG::request_wrench, DEFVAL(0.05));
    ClassDB::bind_method(D_METHOD("set_contacts", "contacts"), &SpidarG::set_contacts);
    ClassDB::bind_method(D_METHOD("clear_contacts"), &SpidarG::clear_contacts);
    ClassDB::bind_method(D_METHOD("get_contact_impulses"), &SpidarG::get_contact_impulses);
    ClassDB::bind_method(D_METHOD("get_touching_contacts"), &SpidarG::get_touching_contacts);
}

void SpidarG::bind_recording() {
    ClassDB::bind_method(D_METHOD("start_recording", "path"), &SpidarG::start_recording);
    ClassDB::bind_method(D_METHOD("stop_recording"), &SpidarG::stop_recording);
    ClassDB::bind_method(D_METHOD("is_recording"), &SpidarG::is_recording);
    ClassDB::bind_method(D_METHOD("get_recording_statistics"), &SpidarG::get_recording_statistics);
    ClassDB::bind_method(D_METHOD("start_replay", "path"), &SpidarG::start_replay);
    ClassDB::bind_method(D_METHOD("stop_replay"), &SpidarG::stop_replay);
    ClassDB::bind_method(D_METHOD("is_replaying"), &SpidarG::is_replaying);
    ClassDB::bind_method(D_METHOD("get_replay_statistics"), &SpidarG::get_replay_statistics);
    ADD_SIGNAL(MethodInfo("recording_failed", PropertyInfo(Variant::STRING, "message")));
    ADD_SIGNAL(MethodInfo("replay_finished", PropertyInfo(Variant::BOOL, "identical"),
                          PropertyInfo(Variant::STRING, "message")));
}

void SpidarG::bind_simulated() {
    ClassDB::bind_method(D_METHOD("simulated_hand_target", "target", "grasp_angle"),
                         &SpidarG::simulated_hand_target);
    ClassDB::bind_method(D_METHOD("set_simulated_hand_firmness", "firmness"),
                         &SpidarG::set_simulated_hand_firmness);
    ClassDB::bind_method(D_METHOD("get_simulated_truth"), &SpidarG::get_simulated_truth);
#ifdef DEBUG_ENABLED
    ClassDB::bind_method(
        D_METHOD("inject_simulated_fault", "fault", "string", "start_s", "duration_s"),
        &SpidarG::inject_simulated_fault, DEFVAL(0), DEFVAL(0.0), DEFVAL(0.0));
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
    BIND_ENUM_CONSTANT(CONTACT_CENTRE);
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
    ClassDB::bind_method(D_METHOD("simulated_buttons", "mask"), &SpidarG::simulated_buttons);
    ADD_SIGNAL(MethodInfo("button_changed", PropertyInfo(Variant::INT, "button"),
                          PropertyInfo(Variant::BOOL, "pressed")));
}
