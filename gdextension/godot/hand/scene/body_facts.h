// How a body feels: what its SpidarGSurface, its metadata, its PhysicsMaterial and the project's default material say of it.
// The order among them is the table "Which material counts" of docs/reference/surfaces.md. Main thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/string_name.hpp>

#include "device/contact/proxy/surface_traits.h"
#include "godot/surface/spidar_g_material.h"

namespace spidar {

struct BodyFacts {
    // Of its PhysicsMaterial; has_physics_material is false for a node without one, and for a server body as the server
    // made it.
    bool has_physics_material = false;
    double physics_friction = 1.0;
    bool rough = false; // of two frictions the larger one counts
    // Of what slips on it; below 0: not said, by the body's own material and by the project's.
    double friction = SpidarGMaterial::kNotSaid;
    double default_friction = SpidarGMaterial::kNotSaid;
    // 0: not said.
    double stiffness_n_m = 0.0;
    double damping_n_s_m = 0.0;
    double squeeze_nm_rad = 0.0;
    SurfaceTraits traits; // scene metres, the body's axes

    // Coulomb coefficient of what slips on the body; mine: of a hand that touches what says nothing.
    [[nodiscard]] double slipping_friction(double mine) const noexcept;
    // Of what rests on it.
    [[nodiscard]] double resting_friction(double mine) const noexcept {
        return std::max(slipping_friction(mine), traits.static_friction);
    }
};

class BodyFactsReader {
public:
    // Reads the project's default material. Once, where the hand enters its scene.
    void open();
    // object: the body's instance id; 0: it has none. is_node: the object is the CollisionObject3D that made the body.
    [[nodiscard]] BodyFacts read(const godot::RID &body, std::uint64_t object, bool is_node);
    // Of old names that bodies still use, each once. Empties the list.
    [[nodiscard]] std::vector<std::string> take_messages();

private:
    struct OldName {
        godot::StringName name;
        const char *property; // of SpidarGMaterial, in its place
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
