// SpidarG: the node that owns a device. It opens the device when it enters the tree of a running
// game, runs the servo loop (in a thread, or by the physics tick), passes requests to the loop and
// publishes its snapshots. The class reference is gdextension/doc_classes/SpidarG.xml.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <godot_cpp/classes/input_event.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>

#include "device/contract/device_claims.h"
#include "device/hid/hid_transport.h"
#include "device/hid/hid_watch.h"
#include "device/loop/servo_loop.h"
#include "device/serial/open_serial_device.h"
#include "device/simulation/simulated_transport.h"
#include "godot/base/node_motion.h"
#include "godot/base/strict.h"
#include "godot/base/world_frame.h"
#include "godot/device/recording_places.h"
#include "godot/device/replay_contacts.h"
#include "godot/device/replay_touches.h"
#include "godot/device/request_owners.h"
#include "godot/settings/project_options.h"
#include "godot/settings/spidar_g_calibration.h"
#include "godot/settings/spidar_g_config.h"

namespace spidar {
class Replay;
}

class SpidarG : public godot::Node3D {
    GDCLASS(SpidarG, godot::Node3D)
    SPIDAR_G_CHECKED_CALLS

public:
    enum DriveMode { DRIVE_THREADED, DRIVE_STEPPED };
    enum State {
        STATE_CLOSED,
        STATE_CONNECTED,
        STATE_ARMING,
        STATE_ACTIVE,
        STATE_FADING,
        STATE_FAULT,
        STATE_TAUT,
        STATE_CALIBRATED
    };
    enum EventLevel { EVENT_INFO, EVENT_WARNING, EVENT_FAULT };
    enum GraspPhase { GRASP_OPEN, GRASP_GRASPED, GRASP_OVER_CLOSED };
    enum ContactTarget {
        CONTACT_CENTER,
        CONTACT_POLE1_PLUS,
        CONTACT_POLE1_MINUS,
        CONTACT_POLE2_PLUS,
        CONTACT_POLE2_MINUS,
        CONTACT_GRASP_STOP,
        CONTACT_TURN_STOP
    };
    // Bits for the degrees of freedom along and about the axes of the node.
    enum DofMask {
        DOF_X = 1,
        DOF_Y = 2,
        DOF_Z = 4,
        DOF_LINEAR = 7,
        DOF_TURN_X = 8,
        DOF_TURN_Y = 16,
        DOF_TURN_Z = 32,
        DOF_ANGULAR = 56,
        DOF_GRASP = 64,
        DOF_ALL = 127
    };
    enum HandFirmness { HAND_LIGHT, HAND_NORMAL, HAND_FIRM };
    enum SimulatedFault {
        FAULT_OUTPUT_CUT,
        FAULT_FROZEN_COUNTS,
        FAULT_COUNT_JUMP,
        FAULT_READ_TIMEOUT,
        FAULT_UNPLUGGED,
        FAULT_STUCK_ENCODER,
        FAULT_BROKEN_STRING,
        FAULT_HAND_RELEASED,
        FAULT_JAMMED_DRUM,
        FAULT_SLIPPED_STRING,
        FAULT_COUNTS_RESET,
        FAULT_REVERSED_ENCODER,
        FAULT_SWAPPED_ENCODERS,
        FAULT_REPORTS_LOST,
        FAULT_REPORTS_REPEATED,
        FAULT_REPORTS_SWAPPED,
        FAULT_LATE_OUTPUT,
        FAULT_BLOCKED_OUTPUT
    };
    enum { CONTACT_STRIDE = 12 };

    SpidarG();
    ~SpidarG() override;

    // Properties and warnings.
    void set_config(const godot::Ref<SpidarGConfig> &config);
    [[nodiscard]] godot::Ref<SpidarGConfig> get_config() const { return config_; }
    [[nodiscard]] godot::Ref<SpidarGConfig> get_effective_config() const;
    void set_calibration(const godot::Ref<SpidarGCalibration> &calibration);
    [[nodiscard]] godot::Ref<SpidarGCalibration> get_calibration() const { return calibration_; }
    void set_enabled(bool enabled);
    [[nodiscard]] bool is_enabled() const { return enabled_; }
    void set_forces_enabled(bool enabled);
    [[nodiscard]] bool are_forces_enabled() const { return forces_wanted_; }
    void set_release_on_focus_loss(bool release);
    [[nodiscard]] bool is_release_on_focus_loss() const { return release_on_focus_loss_; }
    void set_drive_mode(DriveMode mode);
    [[nodiscard]] DriveMode get_drive_mode() const { return drive_mode_; }
    void set_workspace_scale(double scale);
    [[nodiscard]] double get_workspace_scale() const { return workspace_scale_; }
    [[nodiscard]] godot::PackedStringArray _get_configuration_warnings() const override;
    [[nodiscard]] godot::PackedStringArray get_warnings() const {
        return _get_configuration_warnings();
    }

    // Returns the message after a prefix that names this node: SpidarG "name": message
    [[nodiscard]] godot::String named(const std::string &message) const;
    // Reports a refused call, by the signal request_rejected and in the output.
    void refuse(const std::string &message) const;

    // Arming, faults and stepping (spidar_g.cpp).
    void arm();
    void disarm();
    void clear_fault();
    int advance_cycles(int cycles);

    // Real device (spidar_g_device.cpp).
    bool zero_device();
    [[nodiscard]] bool is_simulated() const { return simulated_ != nullptr; }
    [[nodiscard]] godot::String get_device_text() const;
    [[nodiscard]] static godot::Array list_devices();
    [[nodiscard]] godot::Dictionary get_device_info() const;

    // Safety (spidar_g_safety.cpp).
    void panic_stop();
    bool zero_at_home();

    // Requests (spidar_g_requests.cpp).
    bool request_wrench(const godot::Vector3 &force, const godot::Vector3 &moment,
                        double grasp_torque, double duration_s, const godot::String &owner);
    bool set_contacts(const godot::PackedFloat64Array &contacts, const godot::String &owner);
    void clear_contacts(const godot::String &owner);
    [[nodiscard]] int get_free_contacts(const godot::String &owner) const;
    // Coupling and effects (spidar_g_effects.cpp).
    bool set_coupling_gains(const godot::PackedFloat64Array &stiffness,
                            const godot::PackedFloat64Array &damping, double max_force,
                            double max_moment, double max_grasp_torque);
    bool set_coupling(const godot::Transform3D &target, double grasp_angle,
                      const godot::Vector3 &linear_velocity, const godot::Vector3 &angular_velocity,
                      double grasp_rate, int dof_mask);
    void clear_coupling();
    bool set_viscous_effect(int id, double linear, double angular, double grasp, int dof_mask,
                            double duration_s);
    bool set_force_effect(int id, const godot::Vector3 &force, const godot::Vector3 &moment,
                          double grasp_torque, double duration_s);
    bool set_spring_effect(int id, const godot::Transform3D &centre, double grasp_angle,
                           double linear, double angular, double grasp, int dof_mask,
                           double duration_s);
    bool set_vibration_effect(int id, const godot::Vector3 &force, const godot::Vector3 &moment,
                              double grasp_torque, double frequency_hz, double duration_s);
    bool set_detent_effect(int id, const godot::Transform3D &centre, double grasp_angle,
                           double spacing, double strength, int dof_mask, double duration_s);
    void clear_effect(int id);
    void clear_effects();
    [[nodiscard]] godot::Vector3 get_stiffness_limits() const;
    [[nodiscard]] godot::String get_clamp_text() const;
    [[nodiscard]] godot::PackedFloat64Array get_injected_energy() const;

    // For SpidarGHand, in C++ only: sets what the tool can touch and carry; null: nothing. Sets the
    // scene's state_time_s. A replay uses the recorded scenes instead.
    void publish_touch(std::shared_ptr<spidar::TouchScene> touch);
    // The newest snapshot of the servo loop, in the device frame.
    [[nodiscard]] const spidar::ServoSnapshot &snapshot() const { return snapshot_; }
    [[nodiscard]] spidar::WorldFrame world() const;
    [[nodiscard]] const spidar::ServoSettings &servo_settings() const { return settings_; }

    // State (spidar_g_state.cpp). Poses, velocities and wrenches are in world coordinates.
    [[nodiscard]] State get_state() const;
    [[nodiscard]] godot::String get_state_text() const;
    [[nodiscard]] godot::String get_fault_text() const;
    [[nodiscard]] double get_device_time() const;
    [[nodiscard]] godot::Transform3D get_grip_transform() const;
    [[nodiscard]] godot::Transform3D get_pole_transform(int pole) const;
    [[nodiscard]] godot::Vector3 get_pole_end(ContactTarget target) const;
    [[nodiscard]] godot::Vector3 get_string_start(int string) const;
    [[nodiscard]] godot::Vector3 get_string_end(int string) const;
    [[nodiscard]] double get_grasp_angle() const;
    [[nodiscard]] double get_grasp_rate() const;
    [[nodiscard]] GraspPhase get_grasp_phase() const;
    [[nodiscard]] double get_jaw_gap() const;
    [[nodiscard]] double get_grasp_angle_for_gap(double gap_m) const;
    [[nodiscard]] godot::Vector3 get_linear_velocity() const;
    [[nodiscard]] godot::Vector3 get_angular_velocity() const;
    [[nodiscard]] godot::PackedFloat64Array get_string_lengths() const;
    [[nodiscard]] godot::PackedFloat64Array get_string_tensions() const;
    [[nodiscard]] godot::PackedInt32Array get_encoder_counts() const;
    [[nodiscard]] godot::PackedFloat64Array get_requested_wrench() const;
    [[nodiscard]] godot::PackedFloat64Array get_achieved_wrench() const;
    [[nodiscard]] godot::PackedFloat64Array get_wrench_bias() const;
    [[nodiscard]] godot::Dictionary get_contact_impulses(const godot::String &owner) const;
    [[nodiscard]] godot::PackedInt32Array get_touching_contacts(const godot::String &owner) const;
    [[nodiscard]] godot::Dictionary get_statistics() const;
    [[nodiscard]] godot::PackedInt32Array get_lateness_histogram() const;

    // Recording and replay (spidar_g_recording.cpp).
    bool start_recording(const godot::String &path);
    void stop_recording();
    [[nodiscard]] bool is_recording() const;
    [[nodiscard]] godot::Dictionary get_recording_statistics() const;
    bool start_replay(const godot::String &path);
    void stop_replay();
    [[nodiscard]] bool is_replaying() const;
    [[nodiscard]] godot::Dictionary get_replay_statistics() const;

    // Simulated device (spidar_g_simulated.cpp, spidar_g_device.cpp).
    bool set_simulated_hand_target(const godot::Transform3D &target, double grasp_angle);
    void set_simulated_hand_firmness(HandFirmness firmness);
    [[nodiscard]] godot::Dictionary get_simulated_truth() const;
    bool inject_simulated_fault(SimulatedFault fault, int string, double start_s,
                                double duration_s);
    void clear_simulated_faults();
    bool set_simulated_buttons(int mask);

    void _notification(int what);
    // Stops the device when an event of the project's panic key reaches the node.
    void _input(const godot::Ref<godot::InputEvent> &event) override;

protected:
    static void _bind_methods();

private:
    static void bind_setup();
    static void bind_state();
    static void bind_requests();
    static void bind_effects();
    static void bind_recording();
    static void bind_simulated();
    static void bind_device();
    static void bind_enums();

    void resource_changed();
    // Applies changed live fields to the open device. Returns false if it must be opened again.
    bool change_live(const std::string &problem);
    void want_limits(const spidar::LiveLimits &limits);
    void watch_latency();
    void move_limits(double dt_s);
    [[nodiscard]] std::uint64_t resources_revision() const;
    // Reads the project's settings. Called when the node enters the tree and opens a device.
    void read_project();
    // Reads config and calibration into settings_. Returns the problem (settings_ unchanged) or "".
    std::string read_resources();
    [[nodiscard]] const SpidarGConfig &config_or_default() const;
    // Returns a warning if the node is mirrored or scaled, else "". The device opens all the same.
    [[nodiscard]] std::string transform_problem() const;
    [[nodiscard]] bool may_run() const;
    void open_device();
    void open_replay();
    void close_device(const char *why);
    void forget_player();
    // Returns the device that the config selects, or null with the reason.
    std::unique_ptr<spidar::Transport> choose_transport(spidar::Status &status,
                                                        std::string &problem);
    std::unique_ptr<spidar::Transport> simulated_transport(spidar::Status &status,
                                                           std::string &problem);
    std::unique_ptr<spidar::Transport> serial_transport(spidar::Status &status,
                                                        std::string &problem);
    void forget_transport() {
        simulated_ = nullptr;
        hid_ = nullptr;
        serial_ = nullptr;
    }
    [[nodiscard]] bool looks_for_serial() const; // if the config selects boards and has a thread
    void watch_serial_search();
    [[nodiscard]] spidar::HidTransportSettings hid_settings() const;
    // Sets settings_.strings for the opened device. home_counts: its counts at the home pose.
    void use_strings(const spidar::CountArray &home_counts, double metres_per_count);
    void emit_buttons(std::uint8_t before);
    // Ignores buttons that were down when the device opened, until they are released.
    void mask_buttons(const spidar::ServoSnapshot &before);
    void refuse_to_open(spidar::Status status, const std::string &message);
    // Reports a device that did not open. again: true for a later try, which reports a problem only
    // if it differs from that of the try before.
    void refuse_device(spidar::Status status, const std::string &message, bool again);
    void physics_tick();
    // Called deferred in each physics tick: passes the node's pose to motion_.
    void note_place();
    // Returns the plane with its velocity relative to the moving node.
    [[nodiscard]] spidar::ContactPlane seen_from_node(spidar::ContactPlane plane) const;
    // Takes the newest snapshot and emits its signals. recorded: in a replay, the recorded game's
    // read that this call repeats.
    void pull_snapshot(bool physics_tick, const spidar::GameRead *recorded = nullptr);
    // Replays one physics tick: repeats the recorded game's reads up to its next physics tick.
    void replay_tick();
    void emit_edges(const spidar::ServoSnapshot &before, const godot::String &reason);
    void emit_events();
    void tell(const spidar::DeviceEvent &event);
    [[nodiscard]] godot::Dictionary describe_event(const spidar::DeviceEvent &event);
    [[nodiscard]] std::string limited_request() const; // owners and their wrenches, or the gain
    void tell_limited(const spidar::ServoSnapshot &before);
    void beat();
    void follow_grasp_action();
    void watch_loop();
    void set_away(bool away);
    void publish_wrench();
    void publish_contacts();
    // Starts the search for a device that is plugged in later, if the config wants one.
    void watch_for_devices();
    void tell_choice(const std::string &reason);
    [[nodiscard]] std::string why_simulated() const;
    void watch_panic_key(bool watch);
    void poll_panic_key();
    void publish_forces();
    // Only this function changes loop_, which panic_stop() may use from another thread.
    void change_loop(std::unique_ptr<spidar::ServoLoop> loop);
    // Stops a recording that has failed, and emits replay_finished at the end of a replay.
    void watch_recordings();
    void tell_recording_failed();
    bool reject(const std::string &message);
    bool take_effect(const char *method, spidar::Effect effect, int dof_mask);
    [[nodiscard]] std::string fault_message() const;
    [[nodiscard]] std::string name_for_messages() const;

    godot::Ref<SpidarGConfig> config_;
    // Used when config_ is null: the project's default config, or that of the paper's device.
    godot::Ref<SpidarGConfig> default_config_;
    spidar::ProjectOptions options_; // see read_project()
    godot::Ref<SpidarGCalibration> calibration_;
    bool enabled_ = true;
    DriveMode drive_mode_ = DRIVE_THREADED;
    double workspace_scale_ = 1.0;
    // The last usable frame of the node, used while its transform is not usable.
    mutable spidar::WorldFrame last_world_;
    mutable bool world_told_ = false;
    mutable int mirrored_axis_ = -1; // of a mirrored node
    spidar::NodeMotion motion_;

    spidar::ServoSettings settings_;
    spidar::PlantSettings plant_;
    std::string problem_;              // why the device is not or cannot be opened
    std::string problem_when_refused_; // reason of the last failed try to open a real device
    bool trying_again_ = false;        // the next opening is a later try, see refuse_device()
    bool restart_pending_ = false;
    bool forces_wanted_ = false;
    bool release_on_focus_loss_ = true;
    bool is_connected_told_ = false;
    std::uint8_t stale_buttons_ = 0; // bits of buttons that are down since before the opening
    bool panic_key_down_ = false;
    std::atomic<bool> panicked_{false}; // set by panic_stop(), cleared by clear_fault()
    bool waits_for_arm_ = false;        // after a panic: a device that opens does not arm itself
    std::mutex loop_guard_;             // guards the pointer loop_ for panic_stop()
    bool away_ = false;                 // the application is in the background
    double limited_told_s_ = -1.0;      // snapshot time of the last request_limited; -1: none
    bool stall_told_ = false;           // a stalled loop was reported
    spidar::DeviceClaim claim_;
    std::unique_ptr<spidar::ServoLoop> loop_;
    spidar::HidTransport *hid_ = nullptr;                   // owned by loop_
    spidar::SerialTransport *serial_ = nullptr;             // owned by loop_
    std::unique_ptr<spidar::SerialSearch> serial_search_;   // while the boards are not found
    std::unique_ptr<spidar::SerialTransport> found_serial_; // until the device opens
    std::vector<spidar::HidDeviceInfo> tried_;              // plugged in at the last opening
    std::string fallback_;                                  // why the simulated device is used
    spidar::SimulatedTransport *simulated_ = nullptr;       // owned by loop_
    std::string replay_path_;          // played instead of a device, unless empty
    spidar::Replay *replay_ = nullptr; // owned by loop_
    bool replay_end_told_ = false;
    spidar::ReplayContacts replay_contacts_;
    spidar::ReplayTouches replay_touches_;
    std::unique_ptr<spidar::HidWatch> hid_watch_; // while the real device is not open
    spidar::RecordingPlace recording_place_;
    spidar::RequestOwners requests_;
    std::uint64_t opened_revision_ = 0; // revision of config and calibration when the device opened
    spidar::LiveLimits limits_from_;    // the limits move smoothly from these
    spidar::LiveLimits limits_wanted_;  // to these
    double limits_share_ = 1.0;         // share of that way that is done, 0 to 1
    spidar::HapticCommand command_;
    spidar::Coupling coupling_gains_;                         // for the next set_coupling()
    std::array<double, spidar::kMaxEffects> effect_ends_s_{}; // snapshot times
    spidar::ServoSnapshot snapshot_;
    double earlier_time_s_ = 0.0; // device time of earlier loops
};

VARIANT_ENUM_CAST(SpidarG::DriveMode);
VARIANT_ENUM_CAST(SpidarG::State);
VARIANT_ENUM_CAST(SpidarG::EventLevel);
VARIANT_ENUM_CAST(SpidarG::GraspPhase);
VARIANT_ENUM_CAST(SpidarG::ContactTarget);
VARIANT_ENUM_CAST(SpidarG::DofMask);
VARIANT_ENUM_CAST(SpidarG::HandFirmness);
VARIANT_ENUM_CAST(SpidarG::SimulatedFault);
