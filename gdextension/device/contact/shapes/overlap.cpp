#include "device/contact/shapes/overlap.h"

#include <Jolt/Jolt.h>

#include <Jolt/Geometry/EPAPenetrationDepth.h>

namespace spidar {

namespace {

JPH::Vec3 to_jolt(const Vec3 &v) noexcept {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Vec3 from_jolt(JPH::Vec3Arg v) noexcept {
    return {static_cast<double>(v.GetX()), static_cast<double>(v.GetY()),
            static_cast<double>(v.GetZ())};
}

// Both cores relative to the tool's origin, so that single precision suffices for large shapes.
struct PlacedCore {
    const CoreView &core;
    Mat3 rotation;
    Vec3 origin;

    // NOLINTNEXTLINE(readability-identifier-naming): Jolt's name
    [[nodiscard]] JPH::Vec3 GetSupport(JPH::Vec3Arg way) const {
        return to_jolt(origin +
                       rotation * support(core, glm::transpose(rotation) * from_jolt(way)));
    }
};

// Returns the way out along a given direction, exactly.
CoreDistance along(const CoreView &tool, const Placement &tool_at, const CoreView &shape,
                   const Vec3 &normal) noexcept {
    CoreDistance found{.overlap = true};
    found.normal = normal;
    found.on_tool_m = tool_at.origin_m +
                      tool_at.rotation * support(tool, glm::transpose(tool_at.rotation) * -normal);
    found.distance_m = std::min(0.0, glm::dot(found.on_tool_m - support(shape, normal), normal));
    found.on_shape_m = found.on_tool_m - found.distance_m * normal;
    return found;
}

void keep_shorter(CoreDistance &best, const CoreDistance &other) noexcept {
    if (other.distance_m > best.distance_m) {
        best = other;
    }
}

} // namespace

CoreDistance way_out(const CoreView &tool, const Placement &tool_at,
                     const CoreView &shape) noexcept {
    // Directions to try first: the axes of both cores. When the search below fails, one of them is
    // close enough.
    CoreDistance best = along(tool, tool_at, shape, Vec3(0.0, 1.0, 0.0));
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0.0);
        unit[axis] = 1.0;
        for (const Vec3 &way : {unit, -unit, tool_at.rotation[axis], -tool_at.rotation[axis]}) {
            keep_shorter(best, along(tool, tool_at, shape, way));
        }
    }
    const PlacedCore a{tool, tool_at.rotation, Vec3(0.0)};
    const PlacedCore b{shape, Mat3(1.0), -tool_at.origin_m};
    JPH::Vec3 v(1.0F, 0.0F, 0.0F);
    JPH::Vec3 on_a = JPH::Vec3::sZero();
    JPH::Vec3 on_b = JPH::Vec3::sZero();
    JPH::EPAPenetrationDepth search;
    // Tolerance of a thousandth of the depth: a way out is taken in steps and searched again after
    // each.
    constexpr float kTolerance = 1e-3F;
    constexpr float kTouch = 1e-7F;
    const auto status = search.GetPenetrationDepthStepGJK(a, 0.0F, b, 0.0F, kTouch, v, on_a, on_b);
    if (status == JPH::EPAPenetrationDepth::EStatus::Indeterminate &&
        search.GetPenetrationDepthStepEPA(a, b, kTolerance, v, on_a, on_b)) {
        const Vec3 way = from_jolt(v); // direction that moves the shape out
        const double length = glm::length(way);
        if (length > 0.0 && std::isfinite(length)) {
            keep_shorter(best, along(tool, tool_at, shape, -way / length));
        }
    }
    return best;
}

} // namespace spidar
