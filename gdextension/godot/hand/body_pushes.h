// Pushes the bodies that the tool touches: once per tick it applies to each body the impulse that
// the tool exerted on it since the last tick, limited so that light bodies are not thrown. Main
// thread only.
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
        double most_n = 8.0;     // SpidarGConfig.max_force
        double since_s = 0.0;    // device time since the last call
        double time_scale = 1.0; // Engine.time_scale
        // Pose of the proxy and twist of the device, in the device frame.
        Jaws jaws;
        ToolPose pose;
        Twist twist;
        Vec3 node_m_s{0.0}; // velocity of the device's node in the scene
    };

    // Pushes each body by the growth of its impulse sum in `report` since the last call, and stores
    // the sums.
    void push(const TouchReport &report, const TouchedBodies &bodies, const Terms &terms);
    void clear() noexcept { sums_.clear(); }

private:
    struct Sum {
        Vec3 impulse_ns{0.0};
        Vec3 angular_impulse_nms{0.0};
    };
    std::unordered_map<std::int32_t, Sum> sums_; // of the last report, by id of the scene's part
};

} // namespace spidar
