// Newton's third law at game rate: bodies get back what the tool gave them since the tick before. Main thread only.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "device/contact/proxy/tool.h"
#include "device/contract/servo_snapshot.h"
#include "godot/base/world_frame.h"
#include "godot/hand/grasp/touched_bodies.h"

namespace spidar {

class BodyPushes {
public:
    struct Terms {
        WorldFrame frame;        // as the bodies stand in the scene
        double most_n = 8.0;     // the device's own limit
        double since_s = 0.0;    // device time since the tick before
        double time_scale = 1.0; // Engine.time_scale
        // How the tool moves: of the device, in its frame, and of its node in the scene (unit: m/s).
        Jaws jaws;
        ToolPose pose;
        Twist twist;
        Vec3 node_m_s{0.0};
    };

    // Takes the sums of the report, and pushes by what they grew.
    void push(const TouchReport &report, const TouchedBodies &bodies, const Terms &terms);
    void clear() noexcept { sums_.clear(); }

private:
    struct Sum {
        Vec3 impulse_ns{0.0};
        Vec3 angular_impulse_nms{0.0};
    };
    std::unordered_map<std::int32_t, Sum> sums_; // by part of the scene, since its id appeared
};

} // namespace spidar
