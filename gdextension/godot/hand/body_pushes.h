// Applies the tool's impulses of the last tick to the bodies that it touched: Newton's third law at
// game rate. Main thread only.
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
        WorldFrame frame;        // of the device's node at the last physics step
        double most_n = 8.0;     // the device's own limit
        double since_s = 0.0;    // device time since the last tick
        double time_scale = 1.0; // Engine.time_scale
        // Motion of the tool, device frame. node_m_s: motion of the device's node in the scene.
        Jaws jaws;
        ToolPose pose;
        Twist twist;
        Vec3 node_m_s{0.0};
    };

    // Stores the sums of the report and pushes the bodies by their growth.
    void push(const TouchReport &report, const TouchedBodies &bodies, const Terms &terms);
    void clear() noexcept { sums_.clear(); }

private:
    struct Sum {
        Vec3 impulse_ns{0.0};
        Vec3 angular_impulse_nms{0.0};
    };
    std::unordered_map<std::int32_t, Sum> sums_; // by id of the scene's part, since the id appeared
};

} // namespace spidar
