// Friction of the proxy's contacts.
#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// A friction spring goes over to a contact whose surface is turned by less than this.
constexpr double kSameSurface = 0.7;
constexpr std::size_t kGrasp = 6;

Vec3 along_surface(const Vec3 &v, const Vec3 &normal) noexcept {
    return v - glm::dot(normal, v) * normal;
}

} // namespace

// The contact of this pair that pushed nearest to it in the last cycle, on a surface turned little; null: none.
const ProxyContact *ToolProxy::nearest_before(const ProxyContact &contact) const noexcept {
    const ProxyContact *nearest = nullptr;
    for (int i = 0; i < before_count_; ++i) {
        const ProxyContact &other = before_[static_cast<std::size_t>(i)];
        if (other.tool_id != contact.tool_id || other.scene_id != contact.scene_id ||
            !(other.push_n > 0.0) || glm::dot(other.normal, contact.normal) < kSameSurface) {
            continue;
        }
        if (nearest == nullptr || glm::distance(other.point_m, contact.point_m) <
                                      glm::distance(nearest->point_m, contact.point_m)) {
            nearest = &other;
        }
    }
    return nearest;
}

// Springs along surfaces turn the tool by their levers. They are softened where they would turn it harder than the springs
// of its turns and grasp: the part that is left.
double ToolProxy::part_at_levers(const Tool &tool, const ContactScene &scene,
                                 double all_n) const noexcept {
    const DofGains &k = settings_.stiffness;
    const double turn_nm_rad = std::min({k[3], k[4], k[5]});
    double turns = 0.0;
    for (int i = 0; i < count_; ++i) {
        const ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        if (!(contact.push_n > 0.0) || !(scene.parts[contact.scene_part].friction > 0.0)) {
            continue;
        }
        const Vec3 lever_m = contact.point_m - pose_.position_m;
        const Vec3 slides = along_surface(pose_.rotation[0], contact.normal);
        const double jaw_m_rad =
            moves_along(tool.parts[contact.tool_part], tool.jaws, pose_, contact.point_m, slides)
                .grasp_rad;
        turns += contact.push_n / all_n *
                 (glm::dot(lever_m, lever_m) / turn_nm_rad + jaw_m_rad * jaw_m_rad / k[kGrasp]);
    }
    return 1.0 / std::max(1.0, k[0] * turns);
}

// Coulomb friction: at each contact a spring between tool and surface, which slips beyond the cone. All springs together
// are as stiff as one: each has the share of its push.
void ToolProxy::rub(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                    const Twist &velocity, double dt_s) noexcept {
    const Displacement by = between(device_, device);
    const Twist step{by.linear_m, by.angular_rad, by.grasp_rad}; // of the device in this cycle
    double all_n = 0.0;
    for (int i = 0; i < count_; ++i) {
        const ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        all_n += scene.parts[contact.scene_part].friction > 0.0 ? contact.push_n : 0.0;
    }
    const double all_n_m =
        all_n > 0.0 ? settings_.stiffness[0] * part_at_levers(tool, scene, all_n) : 0.0;
    DofLanes sum = lanes(wrench_);
    for (int i = 0; i < count_; ++i) {
        ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        const ScenePart &other = scene.parts[contact.scene_part];
        if (!(contact.push_n > 0.0)) {
            continue;
        }
        const ToolPart &part = tool.parts[contact.tool_part];
        const Vec3 surface_m_s = surface_velocity(other, contact.point_m);
        if (other.friction > 0.0) {
            const double stiffness_n_m = all_n_m * contact.push_n / all_n;
            const double limit_n = other.friction * contact.push_n;
            const Vec3 slid_m =
                point_velocity(part, tool.jaws, device, step, contact.point_m) - dt_s * surface_m_s;
            const ProxyContact *last = nearest_before(contact);
            const Vec3 carried_m = last != nullptr ? last->stretch_m : Vec3(0.0);
            Vec3 stretch_m = along_surface(carried_m + slid_m, contact.normal);
            const double spring_n = stiffness_n_m * glm::length(stretch_m);
            if (spring_n > limit_n) {
                stretch_m *= limit_n / spring_n;
            }
            const Vec3 slides_m_s = along_surface(
                point_velocity(part, tool.jaws, device, velocity, contact.point_m) - surface_m_s,
                contact.normal);
            Vec3 rub_n = -stiffness_n_m * (stretch_m + settings_.damping_s * slides_m_s);
            const double size_n = glm::length(rub_n);
            if (size_n > limit_n) {
                rub_n *= limit_n / size_n;
            }
            contact.stretch_m = stretch_m;
            contact.friction_n = rub_n;
            const DofLanes acts =
                lanes(moves_along(part, tool.jaws, pose_, contact.point_m, rub_n));
            for (std::size_t dof = 0; dof < sum.size(); ++dof) {
                sum[dof] += acts[dof];
            }
        }
        const Vec3 given_n = -(contact.push_n * contact.normal + contact.friction_n);
        PartForce &gets = given_[contact.scene_part];
        gets.force_n += given_n;
        gets.moment_nm += glm::cross(contact.point_m - other.at.origin_m, given_n);
    }
    wrench_ = of_lanes<Wrench>(sum);
}

} // namespace spidar
