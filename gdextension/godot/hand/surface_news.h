// Calls SpidarGSurface::note() for each body with a surface that the hand or its held body touches.
// Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "device/contract/servo_snapshot.h"
#include "godot/base/world_frame.h"
#include "godot/hand/grasp/touched_bodies.h"

namespace godot {
class Object;
}

namespace spidar {

class SurfaceNews {
public:
    // Called once per physics tick. frame: the WorldFrame of the device's node.
    void tell(const TouchReport &report, const TouchedBodies &bodies, const WorldFrame &frame,
              godot::Object &hand);
    // Ends all touches of this hand.
    void clear(godot::Object &hand);

private:
    std::vector<std::uint64_t> touched_; // instance ids of the bodies with a surface
};

} // namespace spidar
