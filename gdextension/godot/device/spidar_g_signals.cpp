// Signals on the edges of the newest snapshot, fault texts, and refusals.
#include "godot/device/spidar_g.h"

#include <godot_cpp/variant/utility_functions.hpp>

#include "device/recording/replay.h"
#include "godot/base/type_conversions.h"

using godot::String;
using godot::UtilityFunctions;
using spidar::DeviceState;
using spidar::Status;

void SpidarG::pull_snapshot(bool physics_tick, const spidar::GameRead *recorded) {
    if (!loop_) {
        return;
    }
    const spidar::ServoSnapshot before = snapshot_;
    const bool is_newer = loop_->latest(snapshot_);
    if (is_newer || physics_tick) {
        loop_->note_read({snapshot_.counters.ticks, physics_tick, command_.contacts_sequence});
    }
    if (is_newer && recorded != nullptr) {
        replay_contacts_.renumber(command_.contacts_sequence,
                                  recorded->contacts_sequence - replay_->contacts_sequence(),
                                  snapshot_);
    }
    if (is_newer && replay_ != nullptr) {
        replay_touches_.renumber(replay_->touch(), snapshot_.touch);
    }
    if (is_newer) {
        if (snapshot_.state == DeviceState::closed) {
            forget_player();
        }
        mask_buttons(before);
        emit_edges(before, spidar::to_godot(fault_message()));
        emit_buttons(before.buttons);
    }
    emit_events();
    tell_limited(before);
    if (loop_) {
        watch_loop();
    }
    watch_recordings();
}

// A listener may close or open the device: later signals use copies.
void SpidarG::emit_edges(const spidar::ServoSnapshot &before, const String &reason) {
    const spidar::ServoSnapshot after = snapshot_;
    const DeviceState now = after.state;
    if (now != before.state && before.state == DeviceState::closed) {
        is_connected_told_ = true;
        emit_signal("device_connected");
    }
    if (after.grasp != before.grasp) {
        switch (after.grasp) {
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
    if (now != before.state) {
        if (now == DeviceState::active) {
            emit_signal("armed");
        } else if (before.state == DeviceState::active) {
            emit_signal("disarmed");
        }
        if (now == DeviceState::fault) {
            emit_signal("fault_raised", static_cast<int>(after.fault), reason);
        }
        if (now == DeviceState::closed) {
            is_connected_told_ = false;
            emit_signal("device_lost", reason);
        }
    }
    if (after.tension_status == Status::wrench_limited &&
        before.tension_status != Status::wrench_limited) {
        emit_signal("tension_saturated");
    }
}

std::string SpidarG::fault_message() const {
    if (panicked_.load() && !loop_ && problem_.empty()) {
        return std::string(spidar::describe(Status::panic_stopped)) +
               " The device opens in this state: call clear_fault(), then arm().";
    }
    if (snapshot_.fault == Status::ok) {
        return problem_;
    }
    std::string message = spidar::describe(snapshot_.fault);
    if (snapshot_.fault_string >= 0) {
        message += " String " + std::to_string(snapshot_.fault_string + 1) + " (of 1-8).";
    }
    return message;
}

// A device that is closed has no grasp and no pressed button.
void SpidarG::forget_player() {
    snapshot_.grasp = spidar::GraspPhase::open;
    snapshot_.buttons = 0;
}

String SpidarG::named(const std::string &message) const {
    return spidar::to_godot("SpidarG \"" + name_for_messages() + "\": " + message);
}

void SpidarG::refuse(const std::string &message) const {
    const String text = named(message);
    UtilityFunctions::push_error(text);
    const_cast<SpidarG *>(this)->emit_signal("request_rejected",
                                             text); // changes no member of this class
}

bool SpidarG::reject(const std::string &message) {
    refuse(message);
    return false;
}
