// Springs between hands that hold one body: each hand feels the others. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include <godot_cpp/variant/transform3d.hpp>

#include "device/contact/proxy/tool_joint.h"
#include "device/contract/haptic_command.h"
#include "godot/base/world_frame.h"
#include "godot/hand/grasp/shared_holds.h"

namespace spidar {

class PartnerTies {
public:
    void drop() { ties_.clear(); }
    // Returns the present ties. stiffness: of the device's own springs in use (TouchReport).
    // in_grip: pose of the held body in the grip, scene meters.
    [[nodiscard]] std::vector<ToolJoint> now(const std::vector<SharedHold> &others,
                                             const DofGains &stiffness,
                                             const godot::Transform3D &in_grip,
                                             const WorldFrame &frame, double tick_s);

private:
    struct Tie {
        ToolJoint joint;
        double left_s = 0.0; // above 0: that hand holds it or released it recently
    };
    std::vector<Tie> ties_;
};

} // namespace spidar
