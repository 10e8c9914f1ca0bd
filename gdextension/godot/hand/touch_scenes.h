// Makes the scene that a hand publishes: its tool, the shapes near the tool, and their surfaces.
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
    // Squeeze stiffness of the held or pinched body; 0: automatic.
    double squeeze_nm_rad = 0.0;
    // True while no force can center the hand on the body that it closes on: softer springs across
    // the jaws then let the pads center themselves.
    bool centres_itself = false;
    std::uint64_t pinched = 0; // RID of the body between the pads; pushed_n_m_kg does not limit it
    // Largest stiffness per kilogram of a body that physics moves (unit: N/m/kg). A larger one
    // would make a light body bounce between a push and its answer a frame later.
    double pushed_n_m_kg = 0.0;
};

struct HeldTool {
    const std::vector<HeldShapes::Part> &parts;
    Placement grip;           // pose of the proxy
    Placement in_grip;        // pose of the body in the grip, device meters
    double stop_rad = 0.0;    // grasp angle at which the pads lie on the body
    bool is_detained = false; // true: the body's shapes do not belong to the tool
};

// Makes the scene. held: null while nothing is held. load: wrench of the carried body on the tool
// about P0, in the device frame.
[[nodiscard]] std::shared_ptr<TouchScene>
make_touch_scene(const Pads &pads, const Jaws &jaws, const std::vector<NearShape> &near,
                 const HeldTool *held, const HandFeel &feel, const ServoSettings &settings,
                 const Wrench &load);

} // namespace spidar
