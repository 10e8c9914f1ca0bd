// Life cycle of the node: resources, opening and closing the device, ticks, signals on edges.
#include "godot/device/spidar_g.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/physics_tick.h"
#include "godot/base/type_conversions.h"
#include "godot/device/live_limits.h"

using godot::Engine;
using godot::Ref;
using godot::String;
using godot::UtilityFunctions;
using spidar::DeviceState;
using spidar::Status;

namespace {

// Range of the workspace scale: from a pollen grain to a town.
constexpr double kLeastWorkspaceScale = 1e-3;
constexpr double kMostWorkspaceScale = 1e3;
// Largest number of cycles per call: 100 s at 1 kHz. More is a unit error.
constexpr int kMostCycles = 100000;

// Revision that no resource reaches.
constexpr std::uint64_t kNeverOpened = ~std::uint64_t{0};

[[nodiscard]] bool in_editor() {
    return Engine::get_singleton()->is_editor_hint();
}

} // namespace

SpidarG::SpidarG() {
    default_config_.instantiate();
    problem_ = read_resources();
}

SpidarG::~SpidarG() {
    close_device("The node was freed.");
}

void SpidarG::set_config(const Ref<SpidarGConfig> &config) {
    if (config_ == config) {
        return;
    }
    const auto listener = callable_mp(this, &SpidarG::resource_changed);
    if (config_.is_valid()) {
        config_->disconnect("changed", listener);
    }
    config_ = config;
    opened_revision_ = kNeverOpened;
    if (config_.is_valid()) {
        config_->connect("changed", listener);
    }
    resource_changed();
}

void SpidarG::set_calibration(const Ref<SpidarGCalibration> &calibration) {
    if (calibration_ == calibration) {
        return;
    }
    const auto listener = callable_mp(this, &SpidarG::resource_changed);
    if (calibration_.is_valid()) {
        calibration_->disconnect("changed", listener);
    }
    calibration_ = calibration;
    opened_revision_ = kNeverOpened;
    if (calibration_.is_valid()) {
        calibration_->connect("changed", listener);
    }
    resource_changed();
}

void SpidarG::resource_changed() {
    const spidar::StringCalibration strings = settings_.strings; // of the open device
    const std::string problem = read_resources();
    if (change_live(problem)) {
        settings_.strings = strings;
        update_configuration_warnings();
        update_gizmos();
        return;
    }
    problem_ = problem;
    // Several fields are often set in a row: the device restarts once, at the next tick.
    restart_pending_ = true;
    update_configuration_warnings();
    update_gizmos();
}

void SpidarG::set_enabled(bool enabled) {
    if (enabled_ == enabled) {
        return;
    }
    enabled_ = enabled;
    if (may_run()) {
        open_device();
    } else {
        close_device("enabled = false.");
    }
}

void SpidarG::set_forces_enabled(bool enabled) {
    forces_wanted_ = enabled;
    publish_forces();
}

void SpidarG::set_drive_mode(DriveMode mode) {
    if (mode != DRIVE_THREADED && mode != DRIVE_STEPPED) {
        refuse("drive_mode = " + std::to_string(static_cast<int>(mode)) +
               ": give DRIVE_THREADED (0) or DRIVE_STEPPED (1); the old value stays.");
        return;
    }
    if (drive_mode_ == mode) {
        return;
    }
    drive_mode_ = mode;
    restart_pending_ = true;
}

void SpidarG::set_workspace_scale(double scale) {
    if (!(scale >= kLeastWorkspaceScale && scale <= kMostWorkspaceScale)) {
        refuse("workspace_scale = " + std::to_string(scale) +
               " (scene meters per device meter): give 0.001 to 1000; the old value stays.");
        return;
    }
    workspace_scale_ = scale;
    update_gizmos();
}

bool SpidarG::may_run() const {
    return enabled_ && is_inside_tree() && !in_editor();
}

std::string SpidarG::name_for_messages() const {
    return std::string(String(get_name()).utf8().get_data());
}

void SpidarG::open_device() {
    const bool again = std::exchange(trying_again_, false);
    close_device("The device is reopened.");
    if (!may_run()) {
        return; // a listener to the closing signals has changed its mind
    }
    restart_pending_ = false;
    read_project();
    set_process_input(options_.panic_key != 0);
    watch_panic_key(true);
    problem_ = read_resources();
    // A refused device is tried again when a resource changes.
    set_physics_process_internal(true);
    if (!replay_path_.empty()) {
        open_replay();
        return;
    }
    if (!problem_.empty()) {
        refuse_to_open(Status::invalid_settings, problem_);
        return;
    }
    Status chosen = Status::ok;
    std::string problem;
    auto transport = choose_transport(chosen, problem);
    if (!transport) {
        if (chosen == Status::invalid_settings && !looks_for_serial()) {
            refuse_to_open(chosen, problem);
        } else {
            refuse_device(chosen, problem, again);
        }
        return;
    }
    change_loop(std::make_unique<spidar::ServoLoop>(std::move(transport)));
    // Counters of an earlier run have no meaning for the new loop.
    command_.wrench_sequence = 0;
    command_.contacts_sequence = 0;
    command_.contact_count = 0;
    command_.touch_sequence = 0;
    command_.touch = nullptr;
    publish_forces();
    opened_revision_ = resources_revision();
    limits_wanted_ = spidar::live_limits(settings_);
    limits_from_ = limits_wanted_;
    limits_share_ = 1.0;
    command_.limits_sequence = 0;
    command_.limits = limits_wanted_;
    motion_ = spidar::NodeMotion();
    requests_.clear();
    requests_.configure(settings_.safety.wrench_fade_s, settings_.safety.contacts_gone_s);
    loop_->publish(command_);
    const Status status = drive_mode_ == DRIVE_STEPPED ? loop_->start_stepped(settings_)
                                                       : loop_->start_threaded(settings_);
    if (!spidar::usable(status)) {
        change_loop(nullptr);
        forget_transport();
        claim_.release();
        refuse_to_open(status, spidar::describe(status));
        return;
    }
    const std::string odd = transform_problem();
    if (!odd.empty()) {
        UtilityFunctions::push_warning(named(odd));
    }
    watch_for_devices();
    set_process_internal(true);
}

void SpidarG::refuse_to_open(Status status, const std::string &message) {
    problem_ = message;
    const String text = named("the device stays closed. " + message);
    UtilityFunctions::push_error(text);
    // Deferred: a node that opens as its scene enters the tree is not connected yet.
    call_deferred("emit_signal", "fault_raised", static_cast<int>(status), text);
}

void SpidarG::refuse_device(Status status, const std::string &message, bool again) {
    const bool is_new = !again || message != problem_when_refused_;
    problem_ = message;
    problem_when_refused_ = message;
    watch_for_devices();
    if (!is_new) {
        return;
    }
    refuse_to_open(status, message);
    spidar::DeviceEvent event;
    event.kind = spidar::DeviceEventKind::open_failed;
    event.time_s = snapshot_.time_s;
    call_deferred("emit_signal", "device_event", describe_event(event));
}

// Emits the closing counterpart of every signal that was emitted.
void SpidarG::close_device(const char *why) {
    const bool told = is_connected_told_;
    const spidar::ServoSnapshot before = snapshot_;
    if (loop_) {
        loop_->stop(); // motors off, thread joined, then the handle
        change_loop(nullptr);
        forget_transport();
        replay_ = nullptr;
    }
    claim_.release();
    recording_place_.release();
    hid_watch_.reset();
    serial_search_.reset();
    earlier_time_s_ += snapshot_.time_s;
    snapshot_.time_s = 0.0;
    snapshot_.state = DeviceState::closed;
    snapshot_.tensions_n = {};
    snapshot_.requested = {};
    snapshot_.achieved = {};
    snapshot_.tension_status = Status::ok;
    limited_told_s_ = -1.0;
    forget_player();
    if (told) {
        emit_edges(before, spidar::to_godot(std::string(why)));
        emit_buttons(before.buttons);
    }
}

void SpidarG::_notification(int what) {
    switch (what) {
    case NOTIFICATION_ENTER_TREE:
        if (!in_editor()) {
            read_project();
            watch_panic_key(true);
        }
        if (may_run()) {
            open_device();
        } else if (in_editor()) {
            read_project();
            problem_ = read_resources();
            set_notify_transform(true);
        }
        break;
    case NOTIFICATION_TRANSFORM_CHANGED:
        update_configuration_warnings(); // in the editor only
        break;
    case NOTIFICATION_EXIT_TREE:
        close_device("The node left the scene tree.");
        watch_panic_key(false);
        set_process_input(false);
        set_process_internal(false);
        set_physics_process_internal(false);
        break;
    case NOTIFICATION_INTERNAL_PHYSICS_PROCESS:
        physics_tick();
        break;
    case NOTIFICATION_APPLICATION_FOCUS_OUT:
    case NOTIFICATION_APPLICATION_PAUSED:
        set_away(release_on_focus_loss_);
        break;
    case NOTIFICATION_APPLICATION_FOCUS_IN:
    case NOTIFICATION_APPLICATION_RESUMED:
        set_away(false);
        break;
    case NOTIFICATION_INTERNAL_PROCESS:
        pull_snapshot(false);
        break;
    default:
        break;
    }
}

void SpidarG::physics_tick() {
    if (hid_watch_ && hid_watch_->found()) {
        restart_pending_ = true; // to the device that was plugged in, or that did not open
        trying_again_ = true;
    }
    watch_serial_search();
    if (restart_pending_ && may_run()) {
        open_device();
    }
    if (!loop_) {
        return;
    }
    watch_latency();
    move_limits(spidar::physics_tick_s());
    if (requests_.wrench_changes(snapshot_.time_s)) {
        publish_wrench();
    }
    publish_forces();
    follow_grasp_action();
    beat();
    if (replay_ != nullptr) {
        replay_tick();
    } else {
        if (drive_mode_ == DRIVE_STEPPED) {
            loop_->advance(1, spidar::physics_ticks_per_second());
        }
        pull_snapshot(true);
    }
    call_deferred("_note_place");
}

int SpidarG::advance_cycles(int cycles) {
    if (!loop_ || drive_mode_ != DRIVE_STEPPED) {
        reject("advance_cycles: no device is open with drive_mode = DRIVE_STEPPED: set drive_mode "
               "and open one first.");
        return 0;
    }
    if (cycles < 0 || cycles > kMostCycles) {
        reject("advance_cycles: cycles = " + std::to_string(cycles) + ": give 0 to 100000.");
        return 0;
    }
    publish_forces();
    const int run = loop_->advance(static_cast<std::uint32_t>(cycles),
                                   static_cast<std::uint32_t>(std::lround(settings_.rate_hz)));
    pull_snapshot(false);
    return run;
}

void SpidarG::arm() {
    waits_for_arm_ = false;
    publish_forces();
    ++command_.arm_count;
    if (loop_) {
        loop_->publish(command_);
    }
}

void SpidarG::disarm() {
    ++command_.disarm_count;
    if (loop_) {
        loop_->publish(command_);
    }
}

void SpidarG::clear_fault() {
    if (panicked_.exchange(false)) {
        waits_for_arm_ = true;
    }
    publish_forces();
    ++command_.clear_fault_count;
    if (loop_) {
        loop_->publish(command_);
    }
}

spidar::WorldFrame SpidarG::world() const {
    const godot::Transform3D place = is_inside_tree() ? get_global_transform() : get_transform();
    const int mirrored = spidar::WorldFrame::mirrored_axis_of(place);
    if ((mirrored < 0) != (mirrored_axis_ < 0)) {
        mirrored_axis_ = mirrored; // kept while the node turns: the grip must not jump
    }
    const spidar::WorldFrame now = spidar::WorldFrame::of(place, workspace_scale_, mirrored_axis_);
    if (now.usable()) {
        last_world_ = now;
        world_told_ = false;
    } else if (!world_told_) {
        world_told_ = true;
        refuse("the node's transform is flat or not finite, so the last good transform is kept. "
               "Give the node and its parents finite positions and no scale of zero.");
    }
    last_world_.scale = workspace_scale_;
    return last_world_;
}
