// An edge of a triangle and a core: in closed form for a point and a flat disc, by GJK for the others.
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

struct EdgeDistance {
    enum End : std::uint8_t { inner, from, to }; // where on the edge
    bool beyond = false;                         // farther than the limit; nothing else is set
    bool overlap = false;                        // they meet; nothing else is set
    End end = inner;
    Vec3 on_core{0.0};
    Vec3 on_edge{0.0};
    Vec3 normal{0.0}; // unit, from the edge to the core
};

[[nodiscard]] EdgeDistance edge_distance(const CoreView &core, const Placement &core_at,
                                         const Vec3 &from, const Vec3 &to, double limit_m) noexcept;

} // namespace spidar
