// Properties of a body's surface from its SpidarGSurface, its metadata, its PhysicsMaterial and the
// project's default material. The table "Which material counts" of docs/reference/surfaces.md
// gives their order. Main thread only.
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
    // False for a node without a PhysicsMaterial, and for a server body with default values.
    bool has_physics_material = false;
    double physics_friction = 1.0;
    bool rough = false; // the larger of two frictions applies
    // Sliding friction of the body's own material; negative: not set.
    double friction = SpidarGMaterial::kNotSaid;
    // Sliding friction of the project's default material; negative: not set.
    double default_friction = SpidarGMaterial::kNotSaid;
    // Stiffness, damping and squeeze stiffness; 0: not set.
    double stiffness_n_m = 0.0;
    double damping_n_s_m = 0.0;
    double squeeze_nm_rad = 0.0;
    SurfaceTraits traits; // scene meters, axes of the body
    // Owner of traits.texture.relief.
    std::shared_ptr<const CookedShape> relief;

    // Returns the Coulomb coefficient of sliding on the body. mine: the hand's value, used when
    // nothing else is set.
    [[nodiscard]] double slipping_friction(double mine) const noexcept;
    // Returns the coefficient of sticking to the body.
    [[nodiscard]] double resting_friction(double mine) const noexcept {
        return std::max(slipping_friction(mine), traits.static_friction);
    }
};

class BodyFactsReader {
public:
    // Reads the project's default material. Called once, when the hand enters its scene.
    void open();
    // object: instance id of the body; 0: none. is_node: object is the body's CollisionObject3D.
    [[nodiscard]] BodyFacts read(const godot::RID &body, std::uint64_t object, bool is_node);
    // Returns messages about old names that bodies still use, each once, and empties the list.
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
