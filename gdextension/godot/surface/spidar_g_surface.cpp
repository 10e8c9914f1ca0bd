#include "godot/surface/spidar_g_surface.h"

#include <algorithm>
#include <unordered_map>

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/resource_field.h"
#include "godot/base/type_conversions.h"

namespace {

// Surfaces by the instance id of the body.
std::unordered_map<std::uint64_t, SpidarGSurface *> &surfaces() {
    static std::unordered_map<std::uint64_t, SpidarGSurface *> all;
    return all;
}

} // namespace

SpidarGSurface *SpidarGSurface::of(std::uint64_t body) {
    const auto found = surfaces().find(body);
    return found != surfaces().end() ? found->second : nullptr;
}

void SpidarGSurface::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGSurface." + message));
}

void SpidarGSurface::set_material(const godot::Ref<SpidarGMaterial> &material) {
    material_ = material;
    update_configuration_warnings();
}

void SpidarGSurface::_enter_tree() {
    const auto *const body = cast_to<godot::CollisionObject3D>(get_parent());
    // The first of two surfaces on a body applies; the warning of the other one reports this.
    if (body != nullptr && surfaces().emplace(body->get_instance_id(), this).second) {
        body_ = body->get_instance_id();
    }
}

void SpidarGSurface::_exit_tree() {
    if (body_ != 0) {
        surfaces().erase(body_);
    }
    body_ = 0;
    touches_.clear();
}

godot::PackedStringArray SpidarGSurface::_get_configuration_warnings() const {
    godot::PackedStringArray warnings;
    auto *const body = cast_to<godot::CollisionObject3D>(get_parent());
    if (body == nullptr) {
        warnings.push_back("A SpidarGSurface gives its parent a material: make it a child of a "
                           "StaticBody3D, RigidBody3D or another body.");
    } else if (is_inside_tree() && of(body->get_instance_id()) != this) {
        warnings.push_back(
            "The body already has another SpidarGSurface, which is the one in use: remove one.");
    }
    if (material_.is_null()) {
        warnings.push_back(
            "The material is empty, so the body feels as it would without this node: "
            "give it a SpidarGMaterial.");
    }
    return warnings;
}

double SpidarGSurface::get_touch_force() const {
    double sum_n = 0.0;
    for (const ByHand &one : touches_) {
        sum_n += one.touch.force_n;
    }
    return sum_n;
}

double SpidarGSurface::get_slip_speed() const {
    double most_m_s = 0.0;
    for (const ByHand &one : touches_) {
        most_m_s = std::max(most_m_s, one.touch.slip_m_s);
    }
    return most_m_s;
}

void SpidarGSurface::note(godot::Object &hand, const Touch &touch) {
    const std::uint64_t id = hand.get_instance_id();
    const auto known =
        std::ranges::find_if(touches_, [id](const ByHand &one) { return one.hand == id; });
    const bool touched = known != touches_.end();
    const bool slipped = touched && known->touch.slip_m_s > 0.0;
    const bool touches = touch.force_n > 0.0;
    const bool slips = touches && touch.slip_m_s > 0.0;
    // State is updated before the signals: a listener may free this node.
    if (touches && touched) {
        known->touch = touch;
    } else if (touches) {
        touches_.push_back({id, touch});
    } else if (touched) {
        touches_.erase(known);
    }
    const std::uint64_t self = get_instance_id();
    const auto tell = [self, this](const char *name, auto... arguments) {
        if (godot::ObjectDB::get_instance(self) != nullptr) {
            emit_signal(name, arguments...);
        }
    };
    if (touches && !touched) {
        tell("touched", &hand, touch.point, touch.force_n);
    }
    if (slips && !slipped) {
        tell("slip_started", &hand, touch.slip_m_s);
    }
    if (slipped && !slips) {
        tell("slip_ended", &hand);
    }
    if (touched && !touches) {
        tell("touch_ended", &hand);
    }
}

void SpidarGSurface::_bind_methods() {
    using Self = SpidarGSurface;
    spidar::bind_checked<&Self::set_material, "", "set_material", "material">();
    godot::ClassDB::bind_method(godot::D_METHOD("get_material"), &Self::get_material);
    ADD_PROPERTY(godot::PropertyInfo(godot::Variant::OBJECT, "material",
                                     godot::PROPERTY_HINT_RESOURCE_TYPE, "SpidarGMaterial"),
                 "set_material", "get_material");
    godot::ClassDB::bind_method(godot::D_METHOD("is_touched"), &Self::is_touched);
    godot::ClassDB::bind_method(godot::D_METHOD("get_touch_force"), &Self::get_touch_force);
    godot::ClassDB::bind_method(godot::D_METHOD("get_slip_speed"), &Self::get_slip_speed);
    godot::ClassDB::bind_method(godot::D_METHOD("get_warnings"), &Self::get_warnings);
    const godot::PropertyInfo hand(godot::Variant::OBJECT, "hand",
                                   godot::PROPERTY_HINT_RESOURCE_TYPE, "SpidarGHand");
    const godot::PropertyInfo point(godot::Variant::VECTOR3, "point");
    const godot::PropertyInfo force(godot::Variant::FLOAT, "force");
    const godot::PropertyInfo speed(godot::Variant::FLOAT, "speed");
    ADD_SIGNAL(godot::MethodInfo("touched", hand, point, force));
    ADD_SIGNAL(godot::MethodInfo("touch_ended", hand));
    ADD_SIGNAL(godot::MethodInfo("slip_started", hand, speed));
    ADD_SIGNAL(godot::MethodInfo("slip_ended", hand));
}
