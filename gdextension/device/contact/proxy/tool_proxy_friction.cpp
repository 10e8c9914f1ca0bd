// Friction of the proxy's contacts.
#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Cosine above which a friction spring continues on another contact's surface.
constexpr double kSameSurface = 0.7;
// Time in which a contact that begins to slide falls from the static coefficient, so that a slip
// and not a jolt is felt.
constexpr double kSlip_s = 0.005;
// Time beyond the static limit after which a contact slides. The push of a grip at rest varies by
// some percent from cycle to cycle; without this time the smallest push would end the hold.
constexpr double kBreaks_s = 0.003;
// Speed below which a contact that slid stands still: above the velocity noise of a grip at rest.
constexpr double kStands_m_s = 0.003;

double most_friction(const ScenePart &part) noexcept {
    return std::max(part.friction, part.traits.static_friction);
}

bool on_same_surface(const ProxyContact &a, const ProxyContact &b) noexcept {
    return a.scene_id == b.scene_id && glm::dot(a.normal, b.normal) >= kSameSurface;
}

} // namespace

const ProxyContact *ToolProxy::nearest_before(const ProxyContact &contact,
                                              bool touching) const noexcept {
    const ProxyContact *nearest = nullptr;
    const auto is_nearer = [&](const ProxyContact &other) {
        const bool same_part = other.tool_id == contact.tool_id;
        const bool had_same_part = nearest->tool_id == contact.tool_id;
        return same_part != had_same_part ? same_part
                                          : glm::distance(other.point_m, contact.point_m) <
                                                glm::distance(nearest->point_m, contact.point_m);
    };
    for (int i = 0; i < before_count_; ++i) {
        const ProxyContact &other = before_[static_cast<std::size_t>(i)];
        // Of two fingers side by side on ribs, now one touches and now the other: the one that
        // touches again continues with the friction of the other.
        const bool counts =
            touching ? other.push_n > 0.0 && other.tool_id == contact.tool_id : other.rubs;
        if (counts && on_same_surface(other, contact) && (nearest == nullptr || is_nearer(other))) {
            nearest = &other;
        }
    }
    return nearest;
}

bool ToolProxy::pair_pushes(const ProxyContact &contact) const noexcept {
    for (int i = 0; i < count_; ++i) {
        const ProxyContact &other = contacts_[static_cast<std::size_t>(i)];
        if (other.push_n > 0.0 && other.tool_part == contact.tool_part &&
            other.scene_part == contact.scene_part) {
            return true;
        }
    }
    return false;
}

// The contacts of a surface hold together: two fingers would otherwise walk, one step each.
double ToolProxy::stretch_together_m(const ProxyContact &contact, double own_m) const noexcept {
    double sum_nm = 0.0;
    double push_n = 0.0;
    for (int i = 0; i < before_count_; ++i) {
        const ProxyContact &other = before_[static_cast<std::size_t>(i)];
        if (other.push_n > 0.0 && on_same_surface(other, contact)) {
            sum_nm += other.push_n * glm::length(other.stretch_m);
            push_n += other.push_n;
        }
    }
    return push_n > 0.0 ? sum_nm / push_n : own_m;
}

double ToolProxy::friction_now(ProxyContact &contact, const ScenePart &other,
                               const ProxyContact *last, double stretch_m, double m_per_coefficient,
                               double slides_m_s, double dt_s) const noexcept {
    const double more = most_friction(other) - other.friction;
    const double before_s = last != nullptr ? last->slips_s : -1.0;
    contact.slips_s = before_s;
    contact.strained_s = 0.0;
    if (!(more > 0.0)) {
        // A surface that begins to hold does not catch what slides on it.
        contact.slips_s = last != nullptr && last->held_s < kHolds_s ? kSlip_s : -1.0;
    } else if (before_s >= 0.0) {
        contact.slips_s = before_s + dt_s;
        const bool stands = other.traits.catches_again || slides_m_s < kStands_m_s;
        if (contact.slips_s > kSlip_s && stands) {
            contact.slips_s = -1.0;
        }
    } else if (stretch_together_m(contact, stretch_m) > most_friction(other) * m_per_coefficient) {
        contact.strained_s = (last != nullptr ? last->strained_s : 0.0) + dt_s;
        if (contact.strained_s > kBreaks_s) {
            contact.slips_s = 0.0;
            contact.strained_s = 0.0;
        }
    }
    const double kept =
        contact.slips_s < 0.0 ? 1.0 : std::max(0.0, 1.0 - contact.slips_s / kSlip_s);
    return other.friction + kept * more;
}

// Springs along surfaces turn the tool by their levers. Returns the share of their stiffness that
// does not turn it harder than the springs of its turns and grasp.
double ToolProxy::part_at_levers(const Tool &tool, const ContactScene &scene,
                                 double all_n) const noexcept {
    const DofGains &k = settings_.stiffness;
    const double turn_nm_rad = std::min({k[3], k[4], k[5]});
    double turns = 0.0;
    for (int i = 0; i < count_; ++i) {
        const ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        if (!(contact.push_n > 0.0) || !(most_friction(scene.parts[contact.scene_part]) > 0.0)) {
            continue;
        }
        const Vec3 lever_m = contact.point_m - pose_.position_m;
        const Vec3 slides = along_surface(pose_.rotation[0], contact.normal);
        const double jaw_m_rad =
            moves_along(tool.parts[contact.tool_part], tool.jaws, pose_, contact.point_m, slides)
                .grasp_rad;
        turns += contact.push_n / all_n *
                 (glm::dot(lever_m, lever_m) / turn_nm_rad + jaw_m_rad * jaw_m_rad / k[kGraspLane]);
    }
    return 1.0 / std::max(1.0, k[0] * turns);
}

// Coulomb friction: at each contact a spring between tool and surface, which slides beyond the
// cone. All springs together are as stiff as one: each has a share in proportion to its push.
void ToolProxy::rub(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                    const Twist &velocity, double dt_s) noexcept {
    const Displacement by = between(device_, device);
    const Twist step{by.linear_m, by.angular_rad, by.grasp_rad}; // of the device in this cycle
    double all_n = 0.0;
    for (int i = 0; i < count_; ++i) {
        const ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        all_n += most_friction(scene.parts[contact.scene_part]) > 0.0 ? contact.push_n : 0.0;
    }
    const double all_n_m =
        all_n > 0.0 ? settings_.stiffness[0] * part_at_levers(tool, scene, all_n) : 0.0;
    DofLanes sum = lanes(wrench_);
    for (int i = 0; i < count_; ++i) {
        ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        const ScenePart &other = scene.parts[contact.scene_part];
        contact.rubs = most_friction(other) > 0.0 && pair_pushes(contact);
        if (contact.rubs) {
            const ToolPart &part = tool.parts[contact.tool_part];
            const Vec3 surface_m_s = rubbing_velocity(other, contact.point_m);
            const Vec3 slid_m =
                point_velocity(part, tool.jaws, device, step, contact.point_m) - dt_s * surface_m_s;
            const ProxyContact *last = nearest_before(contact, false);
            const Vec3 carried_m = last != nullptr ? last->stretch_m : Vec3(0.0);
            Vec3 stretch_m = along_surface(carried_m + slid_m, contact.normal);
            // The limit of the cone is equal for all points, since stiffness and limit are both
            // shared in proportion to the push. A corner that is lifted for a moment continues with
            // them and finds its own place again.
            const double size_m = glm::length(stretch_m);
            const Vec3 slides_m_s = along_surface(
                point_velocity(part, tool.jaws, device, velocity, contact.point_m) - surface_m_s,
                contact.normal);
            const double coefficient = friction_now(contact, other, last, size_m, all_n / all_n_m,
                                                    glm::length(slides_m_s), dt_s);
            const double most_m = coefficient * all_n / all_n_m;
            contact.held_s = std::min((last != nullptr ? last->held_s : kHolds_s) + dt_s, kHolds_s);
            // A static friction that holds lets the spring stretch on, and limits its force.
            const bool holds = contact.slips_s < 0.0 && most_friction(other) > other.friction;
            if (size_m > most_m && !holds) {
                contact.held_s = 0.0;
                stretch_m *= most_m / size_m;
            }
            contact.stretch_m = stretch_m;
            contact.slip_m_s = contact.held_s < kHolds_s ? glm::length(slides_m_s) : 0.0;
            if (contact.push_n > 0.0) {
                const double limit_n = coefficient * contact.push_n;
                Vec3 rub_n = -(all_n_m * contact.push_n / all_n) *
                             (stretch_m + settings_.damping_s * slides_m_s);
                const double size_n = glm::length(rub_n);
                if (size_n > limit_n) {
                    rub_n *= limit_n / size_n;
                }
                contact.friction_n = rub_n;
                add_force(part, tool.jaws, contact.point_m, rub_n, sum);
            }
        }
        if (!(contact.push_n > 0.0)) {
            continue;
        }
        const Vec3 given_n = -(contact.push_n * contact.normal + contact.friction_n);
        PartForce &gets = given_[contact.scene_part];
        gets.force_n += given_n;
        gets.moment_nm += glm::cross(contact.point_m - other.at.origin_m, given_n);
    }
    wrench_ = of_lanes<Wrench>(sum);
}

} // namespace spidar
