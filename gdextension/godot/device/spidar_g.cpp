// Life of the node: resources, opening and closing the device, the tick, signals on edges.
#include "godot/device/spidar_g.h"

#include <cmath>
#include <cstdint>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"

using godot::Engine;
using godot::Ref;
using godot::String;
using godot::UtilityFunctions;
using spidar::DeviceState;
using spidar::Status;

namespace {

[[nodiscard]] bool in_editor() {
    return Engine::get_singleton()->is_editor_hint();
}

} // namespace

SpidarG::SpidarG() {
    default_config_.instantiate();
    problem_ = read_resources();
}

SpidarG::~SpidarG() {
    close_device();
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
    if (calibration_.is_valid()) {
        calibration_->connect("changed", listener);
    }
    resource_changed();
}

void SpidarG::resource_changed() {
    problem_ = read_resources();
    // Several fields are often set in a row: the device restarts once, at the next tick, and arms anew.
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
        close_device();
    }
}

void SpidarG::set_forces_enabled(bool enabled) {
    forces_wanted_ = enabled;
    publish_forces();
}

void SpidarG::set_drive_mode(DriveMode mode) {
    if (drive_mode_ == mode) {
        return;
    }
    drive_mode_ = mode;
    restart_pending_ = true;
}

void SpidarG::set_workspace_scale(double scale) {
    if (!(scale > 0.0 && std::isfinite(scale))) {
        reject("workspace_scale = " + std::to_string(scale) +
               " scene m per device m: give a finite value above zero.");
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
    close_device();
    restart_pending_ = false;
    read_project();
    set_process_input(options_.panic_key != 0);
    problem_ = read_resources();
    // Even a refused device is retried when a resource changes.
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
        refuse_to_open(chosen, problem);
        return;
    }
    loop_ = std::make_unique<spidar::ServoLoop>(std::move(transport));
    // Counters of an earlier run say nothing to the new loop.
    command_.wrench_sequence = 0;
    command_.contacts_sequence = 0;
    command_.contact_count = 0;
    loop_->publish(command_);
    const Status status = drive_mode_ == DRIVE_STEPPED ? loop_->start_stepped(settings_)
                                                       : loop_->start_threaded(settings_);
    if (!spidar::usable(status)) {
        loop_.reset();
        simulated_ = nullptr;
        hid_ = nullptr;
        claim_.release();
        refuse_to_open(status, spidar::describe(status));
        return;
    }
    set_process_internal(true);
}

void SpidarG::refuse_to_open(Status status, const std::string &message) {
    problem_ = message;
    const String text = spidar::to_godot("SpidarG \"" + name_for_messages() +
                                         "\": the device stays closed. " + message);
    UtilityFunctions::push_error(text);
    emit_signal("fault_raised", static_cast<int>(status), text);
}

void SpidarG::close_device() {
    if (loop_) {
        loop_->stop(); // motors off, thread joined, then the handle
        loop_.reset();
        simulated_ = nullptr;
        hid_ = nullptr;
        replay_ = nullptr;
    }
    claim_.release();
    snapshot_.state = DeviceState::closed;
    snapshot_.tensions_n = {};
    snapshot_.requested = {};
    snapshot_.achieved = {};
}

void SpidarG::_notification(int what) {
    switch (what) {
    case NOTIFICATION_ENTER_TREE:
        if (may_run()) {
            open_device();
        } else if (in_editor()) {
            read_project();
            problem_ = read_resources();
        }
        break;
    case NOTIFICATION_EXIT_TREE:
        close_device();
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
        pull_snapshot();
        break;
    default:
        break;
    }
}

void SpidarG::physics_tick() {
    if (restart_pending_ && may_run()) {
        open_device();
    }
    if (!loop_) {
        return;
    }
    beat();
    if (drive_mode_ == DRIVE_STEPPED) {
        const int hz = Engine::get_singleton()->get_physics_ticks_per_second();
        loop_->advance(1, static_cast<std::uint32_t>(hz > 0 ? hz : 60));
    }
    pull_snapshot();
}

int SpidarG::advance_cycles(int cycles) {
    if (!loop_ || drive_mode_ != DRIVE_STEPPED) {
        reject("advance_cycles needs an open device with drive_mode DRIVE_STEPPED.");
        return 0;
    }
    if (cycles < 0) {
        reject("advance_cycles: cycles = " + std::to_string(cycles) + ": give 0 or more.");
        return 0;
    }
    const int run = loop_->advance(static_cast<std::uint32_t>(cycles),
                                   static_cast<std::uint32_t>(std::lround(settings_.rate_hz)));
    pull_snapshot();
    return run;
}

void SpidarG::pull_snapshot() {
    if (!loop_) {
        return;
    }
    const spidar::ServoSnapshot before = snapshot_;
    if (loop_->latest(snapshot_)) {
        emit_edges(before);
        emit_buttons(before.buttons);
    }
    emit_events();
    if (loop_) {
        watch_loop();
    }
    watch_recordings();
}

void SpidarG::emit_edges(const spidar::ServoSnapshot &before) {
    const DeviceState now = snapshot_.state;
    if (now != before.state) {
        if (before.state == DeviceState::closed) {
            emit_signal("device_connected");
        }
        if (now == DeviceState::active) {
            emit_signal("armed");
        } else if (before.state == DeviceState::active) {
            emit_signal("disarmed");
        }
        if (now == DeviceState::closed) {
            emit_signal("device_lost", spidar::to_godot(fault_message()));
        }
        if (now == DeviceState::fault) {
            emit_signal("fault_raised", static_cast<int>(snapshot_.fault),
                        spidar::to_godot(fault_message()));
        }
    }
    if (snapshot_.grasp != before.grasp) {
        switch (snapshot_.grasp) {
        case spidar::GraspPhase::open:
            emit_signal("released");
            break;
        case spidar::GraspPhase::grasped:
            emit_signal("grasped");
            break;
        case spidar::GraspPhase::over_closed:
            emit_signal("over_closed");
            break;
        }
    }
    if (snapshot_.tension_status == Status::wrench_limited &&
        before.tension_status != Status::wrench_limited) {
        emit_signal("tension_saturated");
    }
}

std::string SpidarG::fault_message() const {
    if (snapshot_.fault == Status::ok) {
        return problem_;
    }
    std::string message = spidar::describe(snapshot_.fault);
    if (snapshot_.fault_string >= 0) {
        message += " String " + std::to_string(snapshot_.fault_string + 1) + " (of 1-8).";
    }
    return message;
}

void SpidarG::arm() {
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
    ++command_.clear_fault_count;
    if (loop_) {
        loop_->publish(command_);
    }
}

spidar::WorldFrame SpidarG::world() const {
    return spidar::WorldFrame::of(is_inside_tree() ? get_global_transform() : get_transform(),
                                  workspace_scale_);
}

bool SpidarG::reject(const std::string &message) {
    const String text = spidar::to_godot("SpidarG \"" + name_for_messages() + "\": " + message);
    UtilityFunctions::push_error(text);
    emit_signal("request_rejected", text);
    return false;
}
