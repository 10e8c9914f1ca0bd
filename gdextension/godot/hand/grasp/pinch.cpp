#include "godot/hand/grasp/pinch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

// Distance at which a pad lies on a surface.
constexpr double kTouch_m = 5e-5;
// Distance of the second pad at which a body is pinched, since the fingers seldom close in its
// middle. Until then a light body yields and would be felt a millimeter late.
constexpr double kAlmost_m = 3e-4;
// Smallest weight of a point: where a pad lies without force, all its points count equally.
constexpr double kLeastWeight_n = 1e-6;

struct Side {
    bool is_near = false;
    bool touches = false;
    double force_n = 0.0; // towards the pad, along the jaws' axis
    Vec3 normal{0.0};     // weighted by force
};

struct Pressed {
    const TouchedBody *body = nullptr;
    std::array<Side, 2> sides{};

    // Negative: not between the pads.
    [[nodiscard]] double rank() const noexcept {
        const bool is_between =
            sides[0].is_near && sides[1].is_near && (sides[0].touches || sides[1].touches);
        return is_between ? std::max(std::min(sides[0].force_n, sides[1].force_n), 0.0) : -1.0;
    }
};

} // namespace

Pinch find_pinch(const TouchReport &report, const TouchedBodies &bodies) noexcept {
    std::array<Pressed, kMostTouchPoints> pressed{};
    int count = 0;
    const Vec3 axis = report.rotation[0];
    for (int i = 0; i < report.point_count; ++i) {
        const TouchPointReport &point = report.points[static_cast<std::size_t>(i)];
        const auto *const pad = std::find(kPadIds.begin(), kPadIds.end(), point.tool_id);
        const TouchedBody *const body = bodies.find(point.scene_id);
        if (pad == kPadIds.end() || body == nullptr || point.gap_m > kAlmost_m) {
            continue;
        }
        auto *const end = pressed.begin() + count;
        auto *place = std::find_if(pressed.begin(), end, [body](const Pressed &one) {
            return one.body->key() == body->key();
        });
        if (place == end) {
            place->body = body;
            ++count;
        }
        const double outward = pad == kPadIds.begin() ? -1.0 : 1.0;
        Side &side = place->sides[static_cast<std::size_t>(pad - kPadIds.begin())];
        side.is_near = true;
        side.touches = side.touches || point.gap_m <= kTouch_m;
        side.force_n += outward * glm::dot(point.force_n, axis);
        side.normal += (glm::length(point.force_n) + kLeastWeight_n) * point.normal;
    }
    const auto *const hardest =
        std::max_element(pressed.begin(), pressed.begin() + std::max(count, 1),
                         [](const Pressed &a, const Pressed &b) { return a.rank() < b.rank(); });
    Pinch pinch;
    if (count == 0 || hardest->rank() < 0.0) {
        return pinch;
    }
    const Vec3 a = glm::normalize(hardest->sides[0].normal);
    const Vec3 b = glm::normalize(hardest->sides[1].normal);
    pinch.body = hardest->body->key();
    pinch.collider = hardest->body->collider;
    pinch.opposition_deg =
        std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * 180.0 / std::numbers::pi;
    pinch.width_rad = report.grasp_rad;
    pinch.facts = hardest->body->facts;
    return pinch;
}

} // namespace spidar
