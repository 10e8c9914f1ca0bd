// The scene that a hand publishes once per tick: its tool, the shapes near it, and their surfaces.
#pragma once

#include <memory>
#include <vector>

#include "device/contact/touch/touch_scene.h"
#include "device/settings/servo_settings.h"
#include "godot/hand/grasp/held_shapes.h"
#include "godot/hand/pads.h"
#include "godot/hand/scene/surroundings.h"

namespace spidar {

struct HandFeel {
    bool contacts = true;
    bool width = true;
    double stiffness_n_m = 0.0; // 0: automatic
    double damping_n_s_m = 2.0;
    double friction = 0.4;
    double squeeze_nm_rad = 0.0; // stiffness of the held or pinched body; 0: automatic
    // True: no force centers the hand on what it closes on; the pads center themselves.
    bool centres_itself = false;
    std::uint64_t pinched = 0; // RID of the body between the pads: it cannot get out of their way
    // Stiffness per kilogram of other bodies that a push moves (unit: N/m/kg). It keeps a body from
    // bouncing between a push and its answer a frame later.
    double pushed_n_m_kg = 0.0;
};

struct HeldTool {
    const std::vector<HeldShapes::Part> &parts;
    Placement grip;    // pose of the proxy
    Placement in_grip; // pose of the body in the grip, device meters
    double stop_rad = 0.0;
    bool is_detained = false; // the body's shapes touch nothing
};

// Makes the scene. held: null while nothing is held. load: wrench of what the tool carries, about
// P0, device frame.
[[nodiscard]] std::shared_ptr<TouchScene>
make_touch_scene(const Pads &pads, const Jaws &jaws, const std::vector<NearShape> &near,
                 const HeldTool *held, const HandFeel &feel, const ServoSettings &settings,
                 const Wrench &load);

} // namespace spidar
