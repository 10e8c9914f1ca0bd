// What the two pads press together, from the points where they touch. Device frame, SI units.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "device/contract/dof_lanes.h"
#include "device/contract/servo_snapshot.h"
#include "godot/hand/grasp/touched_bodies.h"

namespace spidar {

// Ids of the two pads among the tool's parts.
inline constexpr std::array<std::int32_t, 2> kPadIds{1, 2};
// First id of the held body's parts.
inline constexpr std::int32_t kFirstHeldId = 3;

struct Pinch {
    std::uint64_t body = 0;      // TouchedBody::key; 0: nothing is between the pads
    std::uint64_t collider = 0;  // instance id; 0: a body without an object
    double opposition_deg = 0.0; // between the normals of both sides; 180: held square
    double width_rad = 0.0;      // grasp angle of the proxy
    BodyFacts facts;
};

// Returns the body on which one pad lies and the other nearly does; of several the one that is
// pressed hardest.
[[nodiscard]] Pinch find_pinch(const TouchReport &report, const TouchedBodies &bodies) noexcept;

// Returns the squeeze of the fingers (unit: N m): the pull of the grasp spring from the device to
// the proxy. The pads pass it to the body between them or to each other. Valid without forces too,
// so that games without a force display can grasp.
[[nodiscard]] inline double squeeze_nm(const TouchReport &report, double grasp_rad) noexcept {
    const double stiffness_nm_rad = report.stiffness[kGraspLane];
    return stiffness_nm_rad * std::max(grasp_rad - report.grasp_rad, 0.0);
}

} // namespace spidar
