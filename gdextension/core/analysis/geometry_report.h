// Whether a frame and a grip can work together, and if not, why: for a new device before it is built, and for one whose
// published numbers are in doubt. Takes a fraction of a second; not for the servo loop. Allocates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// What the strings can do at one pose, moments over the grip's lever so that all rows are newtons.
struct PoseStatics {
    int rank = 0;        // of the wrench matrix; degrees_of_freedom where nothing is lost
    bool closed = false; // some tensions, all above 0, give no wrench: the grip can be held
    double margin = 0.0; // smallest over largest of them, 0..1
    // Where not closed: a motion (v, omega d, -psi_rate/2 d; length 1) that every string helps or leaves alone and no
    // string hinders. Zero where closed.
    PaperWrench unopposed{};
};

[[nodiscard]] PoseStatics pose_statics(const FrameGeometry &frame, const GripGeometry &grip,
                                       const GripPose &pose) noexcept;

struct GeometryReport {
    int degrees_of_freedom = 7; // 6 for a rigid grip
    PoseStatics at_rest;
    double closure_share =
        0.0; // of the poses tried: P0 within a quarter of the frame, turns within 30 degrees
    int poses = 0;
    // Largest that can be given in every one of the six directions at rest (unit: N, N m), tensions within min..max.
    double force_capacity_n = 0.0;
    double moment_capacity_nm = 0.0;
    std::vector<std::string> complaints; // plain sentences; empty: nothing found
    [[nodiscard]] bool sound() const noexcept { return complaints.empty(); }
};

// Precondition: validate(frame) and validate(grip, frame) are empty. Poses are seeded: the same report each time.
[[nodiscard]] GeometryReport report_geometry(const FrameGeometry &frame, const GripGeometry &grip,
                                             double min_tension_n, double max_tension_n,
                                             int poses = 500);

} // namespace spidar
