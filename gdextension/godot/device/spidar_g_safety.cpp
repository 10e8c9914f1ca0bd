// Safety for the game: panic stop, zero, heartbeat, release on focus loss, events.
#include "godot/device/spidar_g.h"

#include <array>
#include <cstdio>

#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event_key.hpp>
#include <godot_cpp/classes/input_map.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>

#include "godot/base/type_conversions.h"

namespace {

// Time without a cycle after which a loop counts as stalled: longer than any busy desktop delays
// it.
constexpr double kStalled_s = 0.1;

// The input action that stops every device. It exists while a panic key is set; a game may add
// events to it.
constexpr const char *kPanicAction = "spidar_g_panic";

void set_panic_key(int key) {
    static int added = 0; // the key that we added to the action
    godot::InputMap *const map = godot::InputMap::get_singleton();
    const godot::StringName action(kPanicAction);
    if (key != 0 && !map->has_action(action)) {
        map->add_action(action);
        added = 0;
    }
    if (key == added || !map->has_action(action)) {
        return;
    }
    const auto event_of = [](int physical) {
        godot::Ref<godot::InputEventKey> event;
        event.instantiate();
        event->set_device(-1); // of any keyboard
        event->set_physical_keycode(static_cast<godot::Key>(physical));
        return event;
    };
    if (added != 0) {
        map->action_erase_event(action, event_of(added));
    }
    if (key != 0) {
        map->action_add_event(action, event_of(key));
    }
    added = key;
}

} // namespace

void SpidarG::panic_stop() {
    panicked_.store(true); // also for a closed device: it opens stopped
    const std::lock_guard<std::mutex> lock(loop_guard_);
    if (loop_) {
        loop_->panic_stop();
    }
}

void SpidarG::change_loop(std::unique_ptr<spidar::ServoLoop> loop) {
    {
        const std::lock_guard<std::mutex> lock(loop_guard_);
        loop_.swap(loop);
    }
    // From here on panic_stop() finds the new loop; an earlier stop holds for it too.
    if (loop_ && panicked_.load()) {
        loop_->panic_stop();
    }
}

// The key is read from the input state in each frame of the scene tree. Pause, another viewport or
// window, and nodes that mark events as handled do not affect that state.
void SpidarG::watch_panic_key(bool watch) {
    godot::SceneTree *const tree = get_tree();
    const godot::Callable listener = callable_mp(this, &SpidarG::poll_panic_key);
    const godot::StringName frame("process_frame");
    if (watch) {
        set_panic_key(options_.panic_key);
    } else {
        panic_key_down_ = false;
    }
    if (tree != nullptr && tree->is_connected(frame, listener) != watch) {
        if (watch) {
            tree->connect(frame, listener);
        } else {
            tree->disconnect(frame, listener);
        }
    }
}

void SpidarG::poll_panic_key() {
    const godot::StringName action(kPanicAction);
    if (!godot::InputMap::get_singleton()->has_action(action)) {
        return;
    }
    const godot::Input *const input = godot::Input::get_singleton();
    const bool was_down = panic_key_down_;
    panic_key_down_ = input->is_action_pressed(action);
    // A tap that ends within one frame shows only in the second condition. A key that is down as
    // the device opens stops the device too.
    if ((panic_key_down_ && !was_down) || input->is_action_just_pressed(action)) {
        panic_stop();
    }
}

// Handles events that a script pushes into the node's viewport and that are not in the input state.
void SpidarG::_input(const godot::Ref<godot::InputEvent> &event) {
    const godot::Ref<godot::InputEventKey> key{godot::Variant(event)};
    if (key.is_valid() && key->is_pressed() && !key->is_echo() &&
        static_cast<int>(key->get_physical_keycode()) == options_.panic_key) {
        panic_stop();
    }
}

bool SpidarG::zero_at_home() {
    if (!loop_) {
        return reject("zero_at_home: no device is open: open one first.");
    }
    if (panicked_.load() || (waits_for_arm_ && is_simulated())) {
        return reject(
            "zero_at_home: the device was stopped by panic_stop(): call clear_fault() and "
            "arm() first.");
    }
    if (!command_.forces_enabled) {
        return reject(
            "zero_at_home: forces_enabled = false: set it to true, because the strings must be "
            "pulled taut with pretension.");
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

// Handles focus loss: forces end as with forces_enabled = false, and return as when it is set
// again.
void SpidarG::set_away(bool away) {
    away_ = away;
    publish_forces();
}

void SpidarG::publish_forces() {
    const bool would_arm_itself = waits_for_arm_ && is_simulated();
    const bool on = forces_wanted_ && !away_ && !panicked_.load() && !would_arm_itself;
    if (on == command_.forces_enabled) {
        return;
    }
    command_.forces_enabled = on;
    if (loop_) {
        loop_->publish(command_);
    }
}

// Closes the fingers of a rigid grip.
void SpidarG::follow_grasp_action() {
    if (settings_.grip.kind != spidar::GripKind::rigid || !settings_.fingers.by_game) {
        return;
    }
    const double share = config_or_default().grasp_action_strength();
    if (share != command_.grasp_share) {
        command_.grasp_share = share;
        loop_->publish(command_);
    }
}

// Called in each physics tick of a threaded device. Simulated time needs no watch: it stops with
// the game.
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
            loop_->panic_stop(); // the firmware's watchdog does the rest
        }
    }
    stall_told_ = stalled;
}

// Events after the newest snapshot are emitted with the next one, so that a replay emits them in
// the same tick.
void SpidarG::emit_events() {
    spidar::DeviceEvent event;
    while (loop_ && loop_->next_event(event, snapshot_.time_s)) { // a listener may close the device
        tell(event);
    }
}

std::string SpidarG::limited_request() const {
    using Gain = spidar::GainClamp::Gain;
    const spidar::GainClamp::Gain gain = snapshot_.clamp.gain;
    if (gain != Gain::none && gain != Gain::wrench) {
        return std::string(get_clamp_text().utf8().get_data());
    }
    std::string owners = requests_.describe_wrenches(snapshot_.time_s);
    if (owners.empty()) {
        owners = "The sum of contacts, coupling and effects exceeds a limit";
    }
    const spidar::SafetySettings &limits = settings_.safety;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  ". The sum is clamped to max_force = %.2f N, max_moment = %.3f N m, "
                  "max_grasp_torque = %.3f N m of the SpidarGConfig.",
                  limits.max_force_n, limits.max_moment_nm, limits.max_grasp_torque_nm);
    return owners + text.data();
}

// The loop emits an event for a limited sum, but only counts limited single requests and gains.
// This function reports those, at most once per second.
void SpidarG::tell_limited(const spidar::ServoSnapshot &before) {
    constexpr double kApart_s = 1.0;
    const bool limited = snapshot_.counters.clamped_requests > before.counters.clamped_requests;
    if (!limited || before.state == spidar::DeviceState::closed ||
        (limited_told_s_ >= 0.0 && snapshot_.time_s - limited_told_s_ < kApart_s)) {
        return;
    }
    spidar::DeviceEvent event;
    event.kind = spidar::DeviceEventKind::request_limited;
    event.time_s = snapshot_.time_s;
    tell(event);
}

void SpidarG::tell(const spidar::DeviceEvent &event) {
    emit_signal("device_event", describe_event(event));
}

godot::Dictionary SpidarG::describe_event(const spidar::DeviceEvent &event) {
    const spidar::EventDescription &what = spidar::describe(event.kind);
    godot::Dictionary told;
    told["name"] = godot::String(what.name);
    told["category"] = godot::String(what.category);
    told["level"] = static_cast<int>(what.level);
    told["string"] = static_cast<int>(event.string);
    told["value"] = event.value;
    told["unit"] = godot::String(what.unit);
    std::string message = what.message;
    if (event.kind == spidar::DeviceEventKind::request_limited) {
        limited_told_s_ = event.time_s;
        message += " " + limited_request();
    } else if (event.kind == spidar::DeviceEventKind::device_connected) {
        message += " " + std::string(get_device_text().utf8().get_data());
    }
    told["message"] = spidar::to_godot(message);
    told["simulated"] = is_simulated();
    told["remedy"] = godot::String(what.remedy);
    told["time_s"] = event.time_s;
    told["repeated"] = static_cast<int>(event.repeated);
    return told;
}
