// What the two pads press together, read from the points where they touch. Device frame, SI.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "device/contract/dof_lanes.h"
#include "device/contract/servo_snapshot.h"
#include "godot/hand/grasp/touched_bodies.h"

namespace spidar {

// Of the tool's parts.
inline constexpr std::array<std::int32_t, 2> kPadIds{1, 2};
inline constexpr std::int32_t kFirstHeldId = 3;

struct Pinch {
    std::uint64_t body = 0;      // TouchedBody::key; 0: nothing is between the pads
    std::uint64_t collider = 0;  // instance id; 0: a body without an object
    double opposition_deg = 0.0; // between the normals of the two sides: 180 for a box held square
    double width_rad = 0.0;      // grasp angle of the proxy
    BodyFacts facts;
};

// The body that one pad lies on and the other nearly, the hardest pressed if there are several.
[[nodiscard]] Pinch find_pinch(const TouchReport &report, const TouchedBodies &bodies) noexcept;

// What the fingers press with: the pull of the grasp's spring from the device to the proxy. The pads give it to what is
// between them, or to each other. With forces off as well, so that games without a force display can grasp.
[[nodiscard]] inline double squeeze_nm(const TouchReport &report, double grasp_rad) noexcept {
    const double stiffness_nm_rad = report.stiffness[kGraspLane];
    return stiffness_nm_rad * std::max(grasp_rad - report.grasp_rad, 0.0);
}

} // namespace spidar
