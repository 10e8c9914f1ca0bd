#include "godot/hand/surface_news.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "godot/base/type_conversions.h"
#include "godot/surface/spidar_g_surface.h"

namespace spidar {

namespace {

using BodyTouch = std::pair<std::uint64_t, SpidarGSurface::Touch>;

// A listener may free a surface, or the hand itself.
void note_all(const std::vector<BodyTouch> &touches, godot::Object &hand) {
    const std::uint64_t id = hand.get_instance_id();
    for (const auto &[body, touch] : touches) {
        SpidarGSurface *const surface = SpidarGSurface::of(body);
        if (surface != nullptr && godot::ObjectDB::get_instance(id) != nullptr) {
            surface->note(hand, touch);
        }
    }
}

} // namespace

void SurfaceNews::tell(const TouchReport &report, const TouchedBodies &bodies,
                       const WorldFrame &frame, godot::Object &hand) {
    std::vector<BodyTouch> touches;
    for (int i = 0; i < report.point_count; ++i) {
        const TouchPointReport &point = report.points[static_cast<std::size_t>(i)];
        const double push_n = glm::dot(point.force_n, point.normal);
        const TouchedBody *const body = bodies.find(point.scene_id);
        if (!(push_n > 0.0) || body == nullptr || SpidarGSurface::of(body->collider) == nullptr) {
            continue;
        }
        auto place = std::ranges::find_if(
            touches, [body](const auto &one) { return one.first == body->collider; });
        if (place == touches.end()) {
            touches.emplace_back(body->collider, SpidarGSurface::Touch{});
            place = touches.end() - 1;
            place->second.point = to_godot(frame.point_to_world(point.point_m));
        }
        place->second.force_n += push_n;
        place->second.slip_m_s = std::max(place->second.slip_m_s, point.slip_m_s);
    }
    const std::vector<std::uint64_t> before = std::exchange(touched_, {});
    for (const auto &[body, touch] : touches) {
        touched_.push_back(body);
    }
    for (const std::uint64_t body : before) {
        if (std::ranges::find(touches, body, [](const auto &one) { return one.first; }) ==
            touches.end()) {
            touches.emplace_back(body, SpidarGSurface::Touch{});
        }
    }
    note_all(touches, hand);
}

void SurfaceNews::clear(godot::Object &hand) {
    std::vector<BodyTouch> left;
    for (const std::uint64_t body : std::exchange(touched_, {})) {
        left.emplace_back(body, SpidarGSurface::Touch{});
    }
    note_all(left, hand);
}

} // namespace spidar
