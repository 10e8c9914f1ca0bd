// Seams: where two bodies of the scene lie flush, the edge of one is no obstacle to a tool that
// rests on the other.
#include "device/contact/proxy/tool_proxy.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

// Largest step over which the tool is led. Tiles placed in single precision a meter from the origin
// stand out by a hundredth of it.
constexpr double kStep_m = 5e-6;
constexpr int kMostRounds = 3; // at a corner where four tiles meet

} // namespace

// Returns whether the tool, lifted by a step and moved just beyond the edge, is free of the part
// with the edge.
bool ToolProxy::is_flush(const ProxyContact &edge, const ProxyContact &floor, const Tool &tool,
                         const ContactScene &scene, double margin_m, double dt_s,
                         ProxyMemory &memory) noexcept {
    const ScenePart &other = scene.parts[edge.scene_part];
    const ScenePart &below = scene.parts[floor.scene_part];
    const Vec3 apart_m_s =
        surface_velocity(other, edge.point_m) - surface_velocity(below, edge.point_m);
    const double above_m = glm::dot(edge.point_m - floor.point_m, floor.normal);
    if (std::abs(above_m) > kStep_m || dt_s * glm::length(apart_m_s) > kStep_m) {
        return false;
    }
    const Vec3 back = edge.normal - glm::dot(edge.normal, floor.normal) * floor.normal;
    const double slope = glm::length(back); // above 0: the normals differ
    const double way_m = edge.gap_m / slope + kStep_m;
    if (way_m > margin_m) {
        return false;
    }
    const ToolPart &part = tool.parts[edge.tool_part];
    Placement at = placement_of(part, tool.jaws, pose_);
    at.origin_m += 2.0 * kStep_m * floor.normal - way_m / slope * back;
    ClosestPoints found;
    ++queries_;
    const Status status =
        closest_points(*part.shape, at, *other.shape, other.at, 0.0, memory.of(part, other), found);
    return usable(status) && found.count == 0;
}

bool ToolProxy::open_seams(const Tool &tool, const ContactScene &scene,
                           const RowPushes<kMaxRows> &solved, double margin_m, double dt_s,
                           ProxyMemory &memory) noexcept {
    bool opened = false;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const ProxyContact &edge = contacts_[k];
        if (!(solved.push[k] > 0.0)) {
            continue;
        }
        for (int j = 0; j < count_; ++j) {
            const auto l = static_cast<std::size_t>(j);
            const ProxyContact &floor = contacts_[l];
            // The nearest row is never opened: some row always carries the tool.
            const bool carries = rows_[l].depth > 0.0 && floor.gap_m < edge.gap_m &&
                                 floor.gap_m < kStep_m && floor.tool_part == edge.tool_part &&
                                 floor.scene_part != edge.scene_part &&
                                 glm::dot(floor.normal, edge.normal) < kTurned;
            if (carries && is_flush(edge, floor, tool, scene, margin_m, dt_s, memory)) {
                rows_[k].depth = kOpen;
                opened = true;
                break;
            }
        }
    }
    return opened;
}

RowPushes<kMaxRows> ToolProxy::solve_over_seams(const Tool &tool, const ContactScene &scene,
                                                double margin_m, double dt_s,
                                                ProxyMemory &memory) noexcept {
    RowPushes<kMaxRows> solved =
        solve_rows<kMaxRows>(rows_, row_count_, active_mask_, kRowSoftness);
    for (int round = 0; round < kMostRounds; ++round) {
        if (!open_seams(tool, scene, solved, margin_m, dt_s, memory)) {
            break;
        }
        solved = solve_rows<kMaxRows>(rows_, row_count_, active_mask_, kRowSoftness);
    }
    active_mask_ = solved.active_mask;
    return solved;
}

} // namespace spidar
