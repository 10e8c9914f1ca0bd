// Reads the properties of a body's surface from its SpidarGSurface, its metadata, its
// PhysicsMaterial and the project's default material. docs/reference/surfaces.md, "Which material
// counts", says which of them applies. Main thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/string_name.hpp>

#include "device/contact/proxy/surface_traits.h"
#include "godot/surface/spidar_g_material.h"

namespace spidar {

struct BodyFacts {
    // False for a node without a PhysicsMaterial, and for a body without a node whose friction and
    // bounce have the default values.
    bool has_physics_material = false;
    double physics_friction = 1.0;
    bool rough = false; // PhysicsMaterial.rough: the larger of two frictions applies
    // Sliding friction of the body's SpidarGMaterial or metadata; negative: not set.
    double friction = SpidarGMaterial::kNotSaid;
    // Sliding friction of the project's default material; negative: not set.
    double default_friction = SpidarGMaterial::kNotSaid;
    // Stiffness, damping and squeeze stiffness; 0: not set.
    double stiffness_n_m = 0.0;
    double damping_n_s_m = 0.0;
    double squeeze_nm_rad = 0.0;
    SurfaceTraits traits; // scene meters, axes of the body
    // Keeps the shape alive to which traits.texture.relief points.
    std::shared_ptr<const CookedShape> relief;

    // Returns the coefficient of sliding friction. mine: the hand's value; it is combined with that
    // of a PhysicsMaterial, and applies alone when nothing else is set.
    [[nodiscard]] double slipping_friction(double mine) const noexcept;
    // Returns the coefficient of static friction; never below that of sliding friction.
    [[nodiscard]] double resting_friction(double mine) const noexcept {
        return std::max(slipping_friction(mine), traits.static_friction);
    }
};

class BodyFactsReader {
public:
    // Reads the project's default SpidarGMaterial (project setting spidar_g/hand/default_material).
    // Called when the hand enters the scene tree.
    void open();
    // object: instance id of the object that belongs to the body; 0: none. is_node: the object is
    // the CollisionObject3D that made the body.
    [[nodiscard]] BodyFacts read(const godot::RID &body, std::uint64_t object, bool is_node);
    // Returns messages about deprecated metadata, one for each name, and empties the list.
    [[nodiscard]] std::vector<std::string> take_messages();

private:
    struct OldName {
        godot::StringName name;
        const char *property; // property of SpidarGMaterial that replaces it
        bool told = false;
    };
    [[nodiscard]] double from_metadata(const godot::Object &object, OldName &old);

    godot::Ref<SpidarGMaterial> standard_;
    OldName stiffness_{"spidar_stiffness_n_m", "stiffness"};
    OldName friction_{"spidar_friction", "dynamic_friction"};
    OldName squeeze_{"spidar_squeeze_nm_rad", "squeeze_stiffness"};
    std::vector<std::string> messages_;
};

} // namespace spidar
