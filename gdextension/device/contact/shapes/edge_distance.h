// Distance between a triangle's edge and a core: in closed form for points, by a root search for
// flat discs, else by GJK (gjk.h).
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

struct EdgeDistance {
    enum End : std::uint8_t { inner, from, to }; // where on the edge
    // The distance exceeds limit_m; the fields below are not set.
    bool beyond = false;
    // Edge and core meet; the fields below are not set.
    bool overlap = false;
    End end = inner;
    Vec3 on_core{0.0};
    Vec3 on_edge{0.0};
    Vec3 normal{0.0}; // unit vector from the edge to the core
};

[[nodiscard]] EdgeDistance edge_distance(const CoreView &core, const Placement &core_at,
                                         const Vec3 &from, const Vec3 &to, double limit_m) noexcept;

} // namespace spidar
