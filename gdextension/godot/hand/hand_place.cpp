#include "godot/hand/hand_place.h"

#include <string>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/os.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"
#include "godot/device/spidar_g.h"
#include "godot/hand/spidar_g_hand.h"

namespace spidar {

namespace {

using godot::Object;

constexpr const char *kNoDevice =
    "A SpidarGHand works only as a child of a SpidarG node: make it a child of one.";
constexpr const char *kSecondHand =
    "A SPIDAR-G has one grip, so only the first SpidarGHand under a SpidarG acts: remove this one.";
constexpr const char *kEngine =
    "Thin bodies pass through floors in this physics engine: set physics/3d/physics_engine to "
    "Jolt Physics (Project > Tools > SPIDAR-G: Apply Physics Settings).";
constexpr const char *kThread =
    "SpidarGHand does nothing in a separate thread group, because only the main thread may query "
    "the physics space: set process_thread_group of the hand and of its parents to Inherit or Main "
    "Thread.";

bool has_device(const SpidarGHand &hand) {
    return Object::cast_to<SpidarG>(hand.get_parent()) != nullptr;
}

// Returns whether the hand is the first one under its device.
bool is_first(const SpidarGHand &hand) {
    const godot::Node *const parent = hand.get_parent();
    for (int i = 0; i < parent->get_child_count(); ++i) {
        if (const auto *one = Object::cast_to<SpidarGHand>(parent->get_child(i))) {
            return one == &hand;
        }
    }
    return true;
}

void warn(const SpidarGHand &hand, const char *problem) {
    const std::string name = godot::String(hand.get_name()).utf8().get_data();
    godot::UtilityFunctions::push_warning(to_godot("SpidarGHand \"" + name + "\": " + problem));
}

} // namespace

godot::PackedStringArray HandPlace::warnings(const SpidarGHand &hand) {
    godot::PackedStringArray found;
    if (!has_device(hand)) {
        found.push_back(kNoDevice);
    } else if (!is_first(hand)) {
        found.push_back(kSecondHand);
    }
    const godot::Variant engine = godot::ProjectSettings::get_singleton()->get_setting(
        "physics/3d/physics_engine", godot::String());
    if (std::string(engine.stringify().utf8().get_data()) != "Jolt Physics") {
        found.push_back(kEngine);
    }
    return found;
}

void HandPlace::entered(const SpidarGHand &hand) {
    told_ = false;
    if (!has_device(hand) && !godot::Engine::get_singleton()->is_editor_hint()) {
        warn(hand, kNoDevice);
    }
}

bool HandPlace::may_act(const SpidarGHand &hand) {
    const auto *const os = godot::OS::get_singleton();
    const char *problem = is_first(hand) ? nullptr : kSecondHand;
    if (os->get_thread_caller_id() != os->get_main_thread_id()) {
        problem = kThread;
    }
    if (problem != nullptr && !told_) {
        warn(hand, problem);
    }
    told_ = problem != nullptr;
    return !told_;
}

} // namespace spidar
