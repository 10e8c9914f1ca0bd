// Springs between hands that hold the same body, by which each hand feels the others. Main thread
// only.
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
    // Returns the present ties, and for a short time those to hands that released the body.
    // stiffness: TouchReport::stiffness of this hand. in_grip: pose of the held body in the grip,
    // scene meters. frame: of the device's node.
    [[nodiscard]] std::vector<ToolJoint> now(const std::vector<SharedHold> &others,
                                             const DofGains &stiffness,
                                             const godot::Transform3D &in_grip,
                                             const WorldFrame &frame, double tick_s);

private:
    struct Tie {
        ToolJoint joint;
        double left_s = 0.0; // time until the tie is removed, unless that hand still holds the body
    };
    std::vector<Tie> ties_;
};

} // namespace spidar
