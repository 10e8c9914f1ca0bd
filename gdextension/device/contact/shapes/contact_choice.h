// Selects contact points from many candidates. For each direction of the normal (within 3 degrees),
// it selects the nearest, then again and again the one that is farthest from those selected, up to
// four.
#pragma once

#include <array>

#include "device/contact/shapes/closest_points.h"

namespace spidar {

inline constexpr int kMaxCandidates = 256;

// A contact point in the shape's frame. Not initialized: of many candidates few are used.
struct Candidate {
    Vec3 on_tool;
    Vec3 on_shape;
    Vec3 normal;
    double gap_m;
    std::uint32_t face;
    bool core_inside;
    // Selected, or rejected because enough points with its normal are selected.
    bool done;
};

class ContactCandidates { // NOLINT(cppcoreguidelines-pro-type-member-init)
public:
    // Adds a candidate, from points of both cores and the skins. A full list drops its farthest
    // candidate.
    void add(const Vec3 &on_tool_core, double tool_skin_m, const Vec3 &on_shape_core,
             double shape_skin_m, const Vec3 &normal, std::uint32_t face,
             bool core_inside) noexcept;
    // Selects points and appends them to `out`, in the device frame. shape_at: pose of the shape in
    // the device frame. Of points with one normal, those within spacing_m of a selected point are
    // left out.
    void choose(const Placement &shape_at, double spacing_m, ClosestPoints &out) noexcept;

private:
    void take(std::size_t place, const Placement &shape_at, ClosestPoints &out) noexcept;

    std::array<Candidate, kMaxCandidates> points_;
    int count_ = 0;
    bool left_out_ = false;
};

} // namespace spidar
