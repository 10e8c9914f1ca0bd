// The project settings under spidar_g/, which apply to the whole game. Documented in
// docs/how_to/editor.md.
#pragma once

#include <godot_cpp/classes/ref.hpp>

#include "godot/settings/spidar_g_config.h"
#include "godot/surface/spidar_g_material.h"

namespace spidar {

// Adds the settings with their defaults. Called once, when the library is registered.
void register_project_options();

struct ProjectOptions {
    // False: TRANSPORT_AUTOMATIC uses the simulated device.
    bool use_hardware = true;
    // Upper limit of every SpidarGConfig.max_force (unit: N). The default is the end of the
    // inspector's slider.
    double largest_force_n = 40.0;
    // A godot::Key (physical keycode) that stops every device; 0: none.
    int panic_key = 0;
};
// Returns the present settings. A value of the wrong kind, or a force that is not a positive
// number, counts as the default.
[[nodiscard]] ProjectOptions project_options();

// Returns the config for SpidarG nodes that have none of their own. Null when the setting is empty;
// null, with an error in the output, when it names no SpidarGConfig.
[[nodiscard]] godot::Ref<SpidarGConfig> project_config();

// Returns the material for bodies without a SpidarGSurface. Null when the setting is empty; null,
// with an error in the output, when it names no SpidarGMaterial.
[[nodiscard]] godot::Ref<SpidarGMaterial> project_material();

} // namespace spidar
