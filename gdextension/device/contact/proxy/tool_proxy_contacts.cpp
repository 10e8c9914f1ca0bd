// Search for the contacts between the proxy's tool and the scene.
#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace spidar {

namespace {

// Two points of a pair closer than this, with equal normals, are redundant.
constexpr double kSamePoint_m = 3e-4;
constexpr double kSameNormal = 0.9998; // 1 degree

} // namespace

// Keeps the nearest contacts; of two redundant ones the nearer.
void ToolProxy::offer(const ProxyContact &contact) noexcept {
    int worst = 0;
    for (int i = 0; i < count_; ++i) {
        ProxyContact &other = contacts_[static_cast<std::size_t>(i)];
        const bool same = other.tool_part == contact.tool_part &&
                          other.scene_part == contact.scene_part &&
                          glm::dot(other.normal, contact.normal) > kSameNormal &&
                          glm::distance(other.point_m, contact.point_m) < kSamePoint_m;
        if (same) {
            other = contact.gap_m < other.gap_m ? contact : other;
            return;
        }
        worst = other.gap_m > contacts_[static_cast<std::size_t>(worst)].gap_m ? i : worst;
    }
    if (count_ < kMaxPoints) {
        contacts_[static_cast<std::size_t>(count_++)] = contact;
    } else if (contact.gap_m < contacts_[static_cast<std::size_t>(worst)].gap_m) {
        contacts_[static_cast<std::size_t>(worst)] = contact;
    }
}

double ToolProxy::margin_for(const ContactScene &scene, double dt_s) const noexcept {
    double fastest_m_s = 0.0; // where the tool is
    for (int s = 0; s < scene.count; ++s) {
        const ScenePart &part = scene.parts[static_cast<std::size_t>(s)];
        fastest_m_s = std::max(fastest_m_s, glm::length(surface_velocity(part, pose_.position_m)));
    }
    return settings_.margin_m + fastest_m_s * dt_s / (1.0 - kPartOfMargin);
}

void ToolProxy::find_contacts(const Tool &tool, const ContactScene &scene, double margin_m,
                              ProxyMemory &memory) noexcept {
    count_ = 0;
    ClosestPoints found;
    for (int t = 0; t < tool.count; ++t) {
        const ToolPart &part = tool.parts[static_cast<std::size_t>(t)];
        const Placement at = placement_of(part, tool.jaws, pose_);
        for (int s = 0; s < scene.count; ++s) {
            const ScenePart &other = scene.parts[static_cast<std::size_t>(s)];
            if ((part.groups & other.groups) == 0) {
                continue;
            }
            const Vec3 tool_m =
                glm::transpose(other.at.rotation) * (at.origin_m - other.at.origin_m);
            const double look = look_m(other, margin_m);
            if (is_far(*part.shape, tool_m, *other.shape, look)) {
                continue;
            }
            ++queries_;
            const Status status = closest_points(*part.shape, at, *other.shape, other.at, look,
                                                 memory.of(part, other), found);
            for (int i = 0; usable(status) && i < found.count; ++i) {
                const ContactPoint &point = found.points[static_cast<std::size_t>(i)];
                ProxyContact contact;
                contact.tool_part = static_cast<std::uint8_t>(t);
                contact.scene_part = static_cast<std::uint8_t>(s);
                contact.tool_id = part.id;
                contact.scene_id = other.id;
                contact.face = point.face;
                contact.point_m = point.on_shape_m;
                contact.normal = point.normal;
                contact.gap_m = point.gap_m;
                offer(contact);
            }
        }
    }
}

} // namespace spidar
