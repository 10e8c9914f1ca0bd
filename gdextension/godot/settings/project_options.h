// The project settings under spidar_g/: what holds for every SpidarG of a game. Shown in Project > Project Settings; told in
// docs/how_to/editor.md.
#pragma once

#include <godot_cpp/classes/ref.hpp>

#include "godot/settings/spidar_g_config.h"
#include "godot/surface/spidar_g_material.h"

namespace spidar {

// Adds them with their defaults; once, when the library is registered.
void register_project_options();

struct ProjectOptions {
    bool use_hardware = true; // off: TRANSPORT_AUTOMATIC is the simulated device
    double largest_force_n =
        40.0; // no SpidarGConfig.max_force counts for more; the default is the inspector's own limit
    int panic_key = 0; // a physical godot::Key that stops every device; 0: none
};
// As they are now. A value of the wrong kind, or a force that is no number above zero, counts as the default.
[[nodiscard]] ProjectOptions project_options();

// The resource that stands in where a node has no config. Null where none is set; an error is told where what is
// set is no SpidarGConfig.
[[nodiscard]] godot::Ref<SpidarGConfig> project_config();

// The material of bodies that have none of their own. Null where none is set; an error is told where what is set is no
// SpidarGMaterial.
[[nodiscard]] godot::Ref<SpidarGMaterial> project_material();

} // namespace spidar
