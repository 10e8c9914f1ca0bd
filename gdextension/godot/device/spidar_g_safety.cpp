// Safety as the game sees it: panic stop, zero, signs of life, hand-off when the player looks away, events.
#include "godot/device/spidar_g.h"

#include <godot_cpp/classes/input_event_key.hpp>

#include "godot/base/type_conversions.h"

namespace {

// A loop that stands still for longer than any busy desktop makes it wait.
constexpr double kStalled_s = 0.1;

} // namespace

void SpidarG::panic_stop() {
    if (loop_) {
        loop_->panic_stop();
    }
}

void SpidarG::_input(const godot::Ref<godot::InputEvent> &event) {
    const godot::Ref<godot::InputEventKey> key{godot::Variant(event)};
    if (key.is_valid() && key->is_pressed() && !key->is_echo() &&
        static_cast<int>(key->get_physical_keycode()) == options_.panic_key) {
        panic_stop();
    }
}

bool SpidarG::zero_at_home() {
    if (!loop_) {
        return reject("zero_at_home: no device is open. Open one first.");
    }
    if (!command_.forces_enabled) {
        return reject("zero_at_home: forces_enabled = false: switch it on, for the strings have to "
                      "be drawn taut with pretension.");
    }
    ++command_.zero_count;
    loop_->publish(command_);
    return true;
}

void SpidarG::set_release_on_focus_loss(bool release) {
    release_on_focus_loss_ = release;
    if (!release) {
        set_away(false);
    }
}

// The player looks elsewhere: forces go as with forces_enabled = false, and come back as when it is set again.
void SpidarG::set_away(bool away) {
    away_ = away;
    publish_forces();
}

void SpidarG::publish_forces() {
    const bool on = forces_wanted_ && !away_;
    if (on == command_.forces_enabled) {
        return;
    }
    command_.forces_enabled = on;
    if (loop_) {
        loop_->publish(command_);
    }
}

// Each physics tick of a threaded device. Simulated time needs no watch: it stands still with the game.
void SpidarG::beat() {
    if (drive_mode_ == DRIVE_STEPPED) {
        command_.heartbeat = 0;
        return;
    }
    command_.heartbeat = command_.heartbeat + 1 != 0 ? command_.heartbeat + 1 : 1;
    loop_->publish(command_);
}

void SpidarG::watch_loop() {
    const bool stalled = loop_->since_last_cycle_s() > kStalled_s;
    if (stalled && !stall_told_) {
        spidar::DeviceEvent event;
        event.kind = spidar::DeviceEventKind::loop_stalled;
        event.time_s = snapshot_.time_s;
        event.value = loop_->since_last_cycle_s();
        tell(event);
        if (simulated_ == nullptr) {
            loop_
                ->panic_stop(); // what can be done from here; the firmware's watchdog does the rest
        }
    }
    stall_told_ = stalled;
}

void SpidarG::emit_events() {
    spidar::DeviceEvent event;
    while (loop_ && loop_->next_event(event)) { // a listener may close the device
        tell(event);
    }
}

void SpidarG::tell(const spidar::DeviceEvent &event) {
    const spidar::EventDescription &what = spidar::describe(event.kind);
    godot::Dictionary told;
    told["name"] = godot::String(what.name);
    told["category"] = godot::String(what.category);
    told["level"] = static_cast<int>(what.level);
    told["string"] = static_cast<int>(event.string);
    told["value"] = event.value;
    told["unit"] = godot::String(what.unit);
    told["message"] = godot::String(what.message);
    told["remedy"] = godot::String(what.remedy);
    told["time_s"] = event.time_s;
    told["repeated"] = static_cast<int>(event.repeated);
    emit_signal("device_event", told);
}
