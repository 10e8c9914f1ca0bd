// Which of many contact points are handed on: the nearest, then those that are farthest from the ones taken, up to four
// for each direction of the normal.
#pragma once

#include <array>

#include "device/contact/shapes/closest_points.h"

namespace spidar {

inline constexpr int kMaxCandidates = 256;

// A contact point in the shape's frame. Nothing is set at first: there are many, and few are used.
struct Candidate {
    Vec3 on_tool;
    Vec3 on_shape;
    Vec3 normal;
    double gap_m;
    std::uint32_t face;
    bool core_inside;
    bool done; // taken, or behind one that was taken
};

class ContactCandidates { // NOLINT(cppcoreguidelines-pro-type-member-init)
public:
    // From points of both cores and the skins round them. A list that is full keeps the nearer ones.
    void add(const Vec3 &on_tool_core, double tool_skin_m, const Vec3 &on_shape_core,
             double shape_skin_m, const Vec3 &normal, std::uint32_t face,
             bool core_inside) noexcept;
    // Into the device frame; spacing_m: points nearer to each other than this are one.
    void choose(const Placement &shape_at, double spacing_m, ClosestPoints &out) noexcept;

private:
    void take(std::size_t place, const Placement &shape_at, ClosestPoints &out) noexcept;

    std::array<Candidate, kMaxCandidates> points_;
    int count_ = 0;
    bool left_out_ = false;
};

} // namespace spidar
