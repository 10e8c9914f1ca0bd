#include "device/contact/shapes/contact_choice.h"

#include <algorithm>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

// Cosine of 3 degrees: normals closer than this belong to one face.
constexpr double kOneFace = 0.9986;

// Gaps that differ by less (unit: m) are equal: the candidate that was added first counts as
// nearest.
constexpr double kTie_m = 1e-11;

} // namespace

void ContactCandidates::add(const Vec3 &on_tool_core, double tool_skin_m, const Vec3 &on_shape_core,
                            double shape_skin_m, const Vec3 &normal, std::uint32_t face,
                            bool core_inside) noexcept {
    const Candidate point{on_tool_core - tool_skin_m * normal,
                          on_shape_core + shape_skin_m * normal,
                          normal,
                          glm::dot(on_tool_core - on_shape_core, normal) - tool_skin_m -
                              shape_skin_m,
                          face,
                          core_inside,
                          false};
    if (count_ < kMaxCandidates) {
        points_[static_cast<std::size_t>(count_++)] = point;
        return;
    }
    left_out_ = true;
    auto worst =
        std::max_element(points_.begin(), points_.end(),
                         [](const Candidate &a, const Candidate &b) { return a.gap_m < b.gap_m; });
    if (point.gap_m < worst->gap_m) {
        *worst = point;
    }
}

void ContactCandidates::take(std::size_t place, const Placement &shape_at,
                             ClosestPoints &out) noexcept {
    Candidate &from = points_[place];
    from.done = true;
    ContactPoint &point = out.points[static_cast<std::size_t>(out.count++)];
    point.on_tool_m = shape_at.origin_m + shape_at.rotation * from.on_tool;
    point.on_shape_m = shape_at.origin_m + shape_at.rotation * from.on_shape;
    point.normal = shape_at.rotation * from.normal;
    point.gap_m = from.gap_m;
    point.face = from.face;
    point.core_inside = from.core_inside;
}

void ContactCandidates::choose(const Placement &shape_at, double spacing_m,
                               ClosestPoints &out) noexcept {
    out.left_out = out.left_out || left_out_;
    const auto count = static_cast<std::size_t>(count_);
    const std::span<Candidate> points(points_.data(), count);
    std::array<double, kMaxCandidates> apart; // to the nearest selected point of this face
    while (out.count < kMaxContactPoints) {
        std::size_t first = count;
        for (std::size_t i = 0; i < count; ++i) {
            if (!points[i].done &&
                (first == count || points[i].gap_m < points[first].gap_m - kTie_m)) {
                first = i;
            }
        }
        if (first == count) {
            return;
        }
        const Vec3 normal = points[first].normal;
        std::fill_n(apart.begin(), count, std::numeric_limits<double>::infinity());
        std::size_t next = first;
        for (int taken = 0; taken < kPointsPerFace && next < count && out.count < kMaxContactPoints;
             ++taken) {
            const Vec3 here = points[next].on_tool;
            take(next, shape_at, out);
            next = count;
            for (std::size_t i = 0; i < count; ++i) {
                if (points[i].done || glm::dot(points[i].normal, normal) < kOneFace) {
                    continue;
                }
                apart[i] = std::min(apart[i], glm::length(points[i].on_tool - here));
                if (apart[i] > spacing_m && (next == count || apart[i] > apart[next])) {
                    next = i;
                }
            }
        }
        for (std::size_t i = 0; i < count;
             ++i) { // the others of this face stand behind those taken
            points[i].done = points[i].done || glm::dot(points[i].normal, normal) >= kOneFace;
        }
    }
    out.left_out = out.left_out || std::any_of(points.begin(), points.end(),
                                               [](const Candidate &point) { return !point.done; });
}

} // namespace spidar
