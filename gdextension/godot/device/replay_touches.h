// Replaces shape ids in a replay. A recorded snapshot identifies touched shapes by the ids of the
// recorded game, but a game that runs again assigns new ids. Each recorded shape gets the id of a
// similar shape that is now at the same place.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>

#include "device/contact/touch/touch_scene.h"
#include "device/contract/servo_snapshot.h"

namespace spidar {

class ReplayTouches {
public:
    // Stores the scene that the running game wants to publish; a replay does not publish it.
    void note(std::shared_ptr<const TouchScene> live) { live_ = std::move(live); }
    void forget() { live_.reset(); }

    // Gives the parts and points in `report` the ids of the stored scene. recorded: the scene that
    // `report` belongs to. A part without a similar shape at its place gets id 0 (no shape).
    void renumber(const TouchScene &recorded, TouchReport &report) const noexcept {
        std::array<bool, kMaxSceneParts> used{};
        std::array<std::int32_t, kMaxSceneParts> numbers{};
        for (int i = 0; i < report.part_count && i < recorded.scene.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            numbers[k] = number_of(recorded.scene.parts[k], used);
        }
        for (int i = 0; i < report.point_count; ++i) {
            TouchPointReport &point = report.points[static_cast<std::size_t>(i)];
            std::int32_t number = 0;
            for (int s = 0; s < report.part_count; ++s) {
                const auto k = static_cast<std::size_t>(s);
                number = report.parts[k].id == point.scene_id ? numbers[k] : number;
            }
            point.scene_id = number;
        }
        for (int s = 0; s < report.part_count; ++s) {
            const auto k = static_cast<std::size_t>(s);
            report.parts[k].id = numbers[k];
        }
    }

private:
    // Two parts correspond only if they are closer than this: the scenes are one or two physics
    // ticks apart.
    static constexpr double kApart_m = 0.03;
    // Two parts correspond only if the corners of their bounding boxes differ by less than this.
    static constexpr double kSameSize_m = 1e-4;

    [[nodiscard]] std::int32_t number_of(const ScenePart &part,
                                         std::array<bool, kMaxSceneParts> &used) const noexcept {
        std::int32_t number = 0;
        std::size_t taken = kMaxSceneParts;
        double nearest_m = kApart_m;
        for (int i = 0; live_ && i < live_->scene.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const ScenePart &other = live_->scene.parts[k];
            const double apart_m = glm::distance(other.at.origin_m, part.at.origin_m);
            if (!used[k] && apart_m < nearest_m && are_alike(*other.shape, *part.shape)) {
                nearest_m = apart_m;
                number = other.id;
                taken = k;
            }
        }
        if (taken < kMaxSceneParts) {
            used[taken] = true;
        }
        return number;
    }
    [[nodiscard]] static bool are_alike(const CookedShape &a, const CookedShape &b) noexcept {
        const bool plane = a.kind() == ShapeKind::half_space;
        return a.kind() == b.kind() &&
               (plane || (glm::distance(a.lower_m(), b.lower_m()) < kSameSize_m &&
                          glm::distance(a.upper_m(), b.upper_m()) < kSameSize_m));
    }

    std::shared_ptr<const TouchScene> live_;
};

} // namespace spidar
