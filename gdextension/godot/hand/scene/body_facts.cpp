#include "godot/hand/scene/body_facts.h"

#include <cmath>
#include <utility>

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>

#include "core/base/describe_value.h"
#include "godot/settings/project_options.h"
#include "godot/surface/spidar_g_surface.h"

namespace spidar {

namespace {

using godot::Object;
using godot::PhysicsServer3D;

bool has_physics_material(const Object *object) {
    if (const auto *still = Object::cast_to<godot::StaticBody3D>(object)) {
        return still->get_physics_material_override().is_valid();
    }
    const auto *rigid = Object::cast_to<godot::RigidBody3D>(object);
    return rigid != nullptr && rigid->get_physics_material_override().is_valid();
}

void use(double &kept, double said) {
    kept = kept > 0.0 ? kept : said;
}

} // namespace

double BodyFacts::slipping_friction(double mine) const noexcept {
    if (friction >= 0.0) {
        return friction;
    }
    if (has_physics_material) {
        return rough ? std::max(mine, physics_friction) : std::min(mine, physics_friction);
    }
    return default_friction >= 0.0 ? default_friction : mine;
}

void BodyFactsReader::open() {
    standard_ = project_material();
}

std::vector<std::string> BodyFactsReader::take_messages() {
    return std::exchange(messages_, {});
}

// Returns 0 when the metadata is not set.
double BodyFactsReader::from_metadata(const Object &object, OldName &old) {
    if (!object.has_meta(old.name)) {
        return 0.0;
    }
    const godot::Variant value = object.get_meta(old.name);
    if (value.get_type() != godot::Variant::FLOAT && value.get_type() != godot::Variant::INT) {
        return 0.0;
    }
    const auto number = static_cast<double>(value);
    if (!std::isfinite(number) || !(number > 0.0)) {
        return 0.0;
    }
    if (!old.told) {
        old.told = true;
        const auto *const node = Object::cast_to<godot::Node>(&object);
        const std::string name =
            node != nullptr ? godot::String(node->get_name()).utf8().get_data() : "";
        messages_.push_back("the metadata " +
                            std::string(godot::String(old.name).utf8().get_data()) + " of \"" +
                            name +
                            "\" is deprecated: the next version does not read it. Give the "
                            "body a SpidarGSurface whose SpidarGMaterial has " +
                            old.property + " = " + with_unit(number, "") + ".");
    }
    return number;
}

BodyFacts BodyFactsReader::read(const godot::RID &body, std::uint64_t object, bool is_node) {
    auto *const server = PhysicsServer3D::get_singleton();
    // The server stores both flags as a minus sign.
    const auto friction =
        static_cast<double>(server->body_get_param(body, PhysicsServer3D::BODY_PARAM_FRICTION));
    const auto bounce =
        static_cast<double>(server->body_get_param(body, PhysicsServer3D::BODY_PARAM_BOUNCE));
    const Object *const owner = godot::ObjectDB::get_instance(object);
    BodyFacts facts;
    facts.physics_friction = std::abs(friction);
    facts.rough = std::signbit(friction);
    facts.has_physics_material = is_node ? has_physics_material(owner)
                                         : friction != 1.0 || bounce != 0.0 || std::signbit(bounce);
    const SpidarGSurface *const surface = SpidarGSurface::of(object);
    const godot::Ref<SpidarGMaterial> own =
        surface != nullptr ? surface->get_material() : godot::Ref<SpidarGMaterial>();
    if (own.is_valid()) {
        facts.friction = own->get_dynamic_friction();
        facts.stiffness_n_m = own->get_stiffness();
        facts.damping_n_s_m = own->get_damping();
        facts.squeeze_nm_rad = own->get_squeeze_stiffness();
        facts.traits = own->traits();
        facts.relief = own->relief();
    }
    if (owner != nullptr) {
        const double slips = from_metadata(*owner, friction_);
        facts.friction = facts.friction < 0.0 && slips > 0.0 ? slips : facts.friction;
        use(facts.stiffness_n_m, from_metadata(*owner, stiffness_));
        use(facts.squeeze_nm_rad, from_metadata(*owner, squeeze_));
    }
    if (standard_.is_valid()) {
        facts.default_friction = standard_->get_dynamic_friction();
        use(facts.stiffness_n_m, standard_->get_stiffness());
        use(facts.damping_n_s_m, standard_->get_damping());
        use(facts.squeeze_nm_rad, standard_->get_squeeze_stiffness());
        if (!own.is_valid()) {
            facts.traits = standard_->traits();
            facts.relief = standard_->relief();
        }
    }
    return facts;
}

} // namespace spidar
