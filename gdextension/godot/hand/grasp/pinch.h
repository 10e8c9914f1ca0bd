// Finds the body between the two pads, from the points where they touch. Device frame, SI units.
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
    double opposition_deg = 0.0; // angle between the normals of both sides; 180: parallel faces
    double width_rad = 0.0;      // grasp angle of the proxy, a measure of the body's width
    BodyFacts facts;
};

// Returns the body on which one pad lies and the other lies or nearly lies; of several bodies, the
// one that is pressed hardest. Pinch::body is 0 without such a body.
[[nodiscard]] Pinch find_pinch(const TouchReport &report, const TouchedBodies &bodies) noexcept;

// Returns the squeeze of the fingers (unit: N m): the torque of the spring between the device's
// grasp angle grasp_rad and the proxy's. The pads pass it to the body between them or to each
// other. It needs no motor force, so that a game can grasp with forces off.
[[nodiscard]] inline double squeeze_nm(const TouchReport &report, double grasp_rad) noexcept {
    const double stiffness_nm_rad = report.stiffness[kGraspLane];
    return stiffness_nm_rad * std::max(grasp_rad - report.grasp_rad, 0.0);
}

} // namespace spidar
