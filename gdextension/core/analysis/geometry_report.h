// Reports whether a frame and a grip can work together, and if not, why. Meant for a device that is
// being designed and for one whose published numbers are in doubt. Takes a fraction of a second and
// allocates: not for the servo loop.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// What the strings can do at one pose. Moments and grasp torque are divided by the pole half length
// d, so that all rows are newtons.
struct PoseStatics {
    // Rank of the weighted wrench matrix. Below GeometryReport::degrees_of_freedom the strings do
    // not control some direction.
    int rank = 0;
    // True when the strings hold the grip: the rank is full, and some tensions of which the largest
    // is at most 1000 times the smallest give no net wrench.
    bool closed = false;
    // Smallest over largest of those tensions, 0..1. 0 unless closed.
    double margin = 0.0;
    // A motion (v, omega d, -psi_rate/2 d) of length 1 that no string opposes. Zero if the strings
    // hold the grip, and if only the rank is too low.
    PaperWrench unopposed{};
};

[[nodiscard]] PoseStatics pose_statics(const FrameGeometry &frame, const GripGeometry &grip,
                                       const GripPose &pose) noexcept;

struct GeometryReport {
    // 6 for a rigid grip.
    int degrees_of_freedom = 7;
    PoseStatics at_rest;
    // Share (0..1) of the `poses` random poses at which the strings are closed. The poses are drawn
    // from the middle quarter of the motors' box along each axis, turned by up to 30 degrees about
    // each axis, with the grip open.
    double closure_share = 0.0;
    int poses = 0;
    // Largest force that the strings can give at the rest pose in every one of the directions +-x,
    // +-y and +-z, within the tension limits: the smallest of the six capacities.
    double force_capacity_n = 0.0;
    // Largest moment that the strings can give at the rest pose about every axis in both senses,
    // within the tension limits: the smallest of the six capacities.
    double moment_capacity_nm = 0.0;
    // One plain sentence per problem; empty when no problem was found.
    std::vector<std::string> complaints;
    [[nodiscard]] bool sound() const noexcept { return complaints.empty(); }
};

// Requires that validate(frame) and validate(grip, frame) return empty strings. `poses` is the
// number of random poses that are tried. The seed is fixed: equal input gives an equal report.
[[nodiscard]] GeometryReport report_geometry(const FrameGeometry &frame, const GripGeometry &grip,
                                             double min_tension_n, double max_tension_n,
                                             int poses = 500);

} // namespace spidar
