#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/finite.h"
#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Of the margin, what tool and scene together may move before the closest points are looked for again.
constexpr double kPartOfMargin = 0.75;
// Of the margin, the least that the tool may move however fast the scene comes.
constexpr double kLeastStep = 0.1;
// A hand covers a quarter of this in a cycle.
constexpr int kMostPasses = 3;
// A row that stops the proxy from further off than this, or whose normal turns from cycle to cycle by more than that, is
// looked at again from where it stopped: of an edge it is only the tangent, which a proxy that slides over a seam must not
// feel.
constexpr double kAnticipated_m = 1e-6;
constexpr double kTurned = 1.0 - 5e-7; // 1e-3 rad
// Points of a face depend on each other: they share the push, and this part of the stiffness is lost.
constexpr double kRowSoftness = 1e-7;
// Of what a contact and the deepest one would push alone, the most that it pushes beside others: where no place satisfies
// all, as in a slot that is too narrow.
constexpr double kMostPush = 1.5;
// Two points of a pair closer than this, with normals that agree, say the same.
constexpr double kSamePoint_m = 3e-4;
constexpr double kSameNormal = 0.9998; // 1 degree

double dot(const std::array<double, 8> &a, const std::array<double, 8> &b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

std::array<double, 8> scaled(const Displacement &move, const DofGains &stiffness,
                             bool by_root) noexcept {
    const DofLanes row = lanes(move);
    std::array<double, 8> result{};
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double root = std::sqrt(stiffness[i]);
        result[i] = by_root ? row[i] * root : row[i] / root;
    }
    return result;
}

Displacement unscaled(const std::array<double, 8> &move, const DofGains &stiffness) noexcept {
    DofLanes row{};
    for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = move[i] / std::sqrt(stiffness[i]);
    }
    return of_lanes<Displacement>(row);
}

void move_on(ScenePart &part, double dt_s) noexcept {
    part.at.origin_m += dt_s * part.velocity_m_s;
    if (part.angular_rad_s != Vec3(0.0)) {
        part.at.rotation = rotation_exp(dt_s * part.angular_rad_s) * part.at.rotation;
    }
}

// No point of the tool is nearer to the shape than `margin_m`: told by its bounding box.
bool is_far(const ToolShape &tool, const Placement &tool_at, const ScenePart &part,
            double margin_m) noexcept {
    const Vec3 centre_m = glm::transpose(part.at.rotation) * (tool_at.origin_m - part.at.origin_m);
    const Vec3 outside_m = glm::max(
        glm::max(part.shape->lower_m() - centre_m, centre_m - part.shape->upper_m()), Vec3(0.0));
    const double reach_m = tool.reach_m() + margin_m;
    return glm::dot(outside_m, outside_m) > reach_m * reach_m;
}

} // namespace

void ToolProxy::put(const ToolPose &pose) noexcept {
    const ProxySettings settings = settings_;
    *this = ToolProxy();
    settings_ = settings;
    pose_ = pose;
    device_ = pose;
    placed_ = true;
}

// The nearest are kept; of two that say the same the nearer one.
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
    if (count_ < kMaxRows) {
        contacts_[static_cast<std::size_t>(count_++)] = contact;
    } else if (contact.gap_m < contacts_[static_cast<std::size_t>(worst)].gap_m) {
        contacts_[static_cast<std::size_t>(worst)] = contact;
    }
}

void ToolProxy::find_contacts(const Tool &tool, const ContactScene &scene,
                              ProxyMemory &memory) noexcept {
    count_ = 0;
    ClosestPoints found;
    for (int t = 0; t < tool.count; ++t) {
        const ToolPart &part = tool.parts[static_cast<std::size_t>(t)];
        const Placement at = placement_of(part, tool.jaws, pose_);
        for (int s = 0; s < scene.count; ++s) {
            const ScenePart &other = scene.parts[static_cast<std::size_t>(s)];
            if (is_far(*part.shape, at, other, settings_.margin_m)) {
                continue;
            }
            ++queries_;
            const Status status = closest_points(*part.shape, at, *other.shape, other.at,
                                                 settings_.margin_m, memory.of(part, other), found);
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

bool ToolProxy::step_towards(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                             double dt_s) noexcept {
    const DofGains &stiffness = settings_.stiffness;
    const std::array<double, 8> target = scaled(between(pose_, device), stiffness, true);
    std::array<double, kMaxRows> least{}; // what the proxy itself must move along row i
    bool entered = false;
    double fastest_m_s = 0.0;
    for (int s = 0; s < scene.count; ++s) {
        const ScenePart &part = scene.parts[static_cast<std::size_t>(s)];
        fastest_m_s = std::max(fastest_m_s, glm::length(part.velocity_m_s));
    }
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const ProxyContact &contact = contacts_[k];
        const ToolPart &part = tool.parts[contact.tool_part];
        const ScenePart &other = scene.parts[contact.scene_part];
        const Displacement along =
            moves_along(part, tool.jaws, pose_, contact.point_m, contact.normal);
        const double comes_m =
            dt_s * glm::dot(contact.normal, surface_velocity(other, contact.point_m));
        rows_[k] = ConstraintRow();
        rows_[k].row = scaled(along, stiffness, false);
        least[k] = comes_m - contact.gap_m;
        entered = entered || least[k] > 0.0;
        rows_[k].depth = least[k] - dot(rows_[k].row, target);
    }
    const RowPushes<kMaxRows> solved =
        solve_rows<kMaxRows>(rows_, count_, active_mask_, kRowSoftness);
    active_mask_ = solved.active_mask;
    std::array<double, 8> step = target;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        for (std::size_t lane = 0; lane < step.size(); ++lane) {
            step[lane] += solved.push[k] * rows_[k].row[lane];
        }
    }
    double reach_m = 0.0;
    for (int t = 0; t < tool.count; ++t) {
        const ToolPart &part = tool.parts[static_cast<std::size_t>(t)];
        const double jaw_m =
            part.mount == ToolMount::grip ? 0.0 : 0.5 * tool.jaws.gap_m(pose_.grasp_rad);
        reach_m = std::max(reach_m, glm::length(part.at.origin_m) + jaw_m + part.shape->reach_m());
    }
    const auto length_of = [&](const std::array<double, 8> &move) {
        const Displacement by = unscaled(move, stiffness);
        return glm::length(by.linear_m) + reach_m * glm::length(by.angular_rad) +
               0.5 * std::abs(tool.jaws.slope_m_rad(pose_.grasp_rad) * by.grasp_rad);
    };
    const double most_m = std::max(kPartOfMargin * (settings_.margin_m - fastest_m_s * dt_s),
                                   kLeastStep * settings_.margin_m);
    const double length_m = length_of(step);
    const bool cut = length_m > most_m;
    if (cut) {
        // Two steps that break no row have none between them that does: what gets out of the way, and a part of the rest.
        std::array<double, 8> out{};
        if (entered) {
            Rows rows = rows_;
            for (int i = 0; i < count_; ++i) {
                rows[static_cast<std::size_t>(i)].depth = least[static_cast<std::size_t>(i)];
            }
            const RowPushes<kMaxRows> leaving =
                solve_rows<kMaxRows>(rows, count_, active_mask_, kRowSoftness);
            for (int i = 0; i < count_; ++i) {
                const auto k = static_cast<std::size_t>(i);
                for (std::size_t lane = 0; lane < out.size(); ++lane) {
                    out[lane] += leaving.push[k] * rows[k].row[lane];
                }
            }
        }
        const double out_m = length_of(out);
        const double shrink = out_m > most_m ? most_m / out_m : 1.0;
        std::array<double, 8> rest{};
        for (std::size_t lane = 0; lane < rest.size(); ++lane) {
            out[lane] *= shrink;
            rest[lane] = step[lane] - out[lane];
        }
        const double rest_m = length_of(rest);
        const double part =
            rest_m > 0.0 ? std::clamp((most_m - shrink * out_m) / rest_m, 0.0, 1.0) : 0.0;
        for (std::size_t lane = 0; lane < rest.size(); ++lane) {
            step[lane] = out[lane] + part * rest[lane];
        }
    }
    bool anticipated = false;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const ProxyContact &contact = contacts_[k];
        if (solved.push[k] > 0.0 && !anticipated) {
            const ProxyContact *last = nearest_before(contact);
            anticipated = contact.gap_m > kAnticipated_m ||
                          (passes_ == 0 && last != nullptr &&
                           glm::dot(last->normal, contact.normal) < kTurned);
        }
        contacts_[k].gap_m = dot(rows_[k].row, step) - least[k];
    }
    pose_ = moved(pose_, unscaled(step, stiffness));
    return cut || anticipated;
}

// The pushes that the hand feels: with damping, and with what gives way behind a surface.
void ToolProxy::push(const Tool &tool, const ContactScene &scene, const Twist &velocity) noexcept {
    std::array<int, kMaxSceneParts> touching{};
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        touching[contacts_[k].scene_part] += rows_[k].depth > 0.0 ? 1 : 0;
    }
    Rows rows = rows_;
    std::array<double, kMaxRows> alone{};
    double deepest_n = 0.0;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        ProxyContact &contact = contacts_[k];
        const ScenePart &other = scene.parts[contact.scene_part];
        const double softness_m_n = dot(rows[k].row, rows[k].row);
        if (!(rows[k].depth > 0.0)) {
            continue;
        }
        if (other.stiffness_n_m > 0.0) {
            const double more_m_n = std::max(0.0, 1.0 / other.stiffness_n_m - softness_m_n);
            rows[k].compliance = more_m_n * touching[contact.scene_part];
        }
        const Vec3 speed_m_s = point_velocity(tool.parts[contact.tool_part], tool.jaws, pose_,
                                              velocity, contact.point_m) -
                               surface_velocity(other, contact.point_m);
        const double damping_n_s_m = settings_.damping_n_s_m + other.damping_n_s_m;
        // The damper acts as a deeper spring: so the push stays one-sided, and shared.
        rows[k].depth = std::max(0.0, rows[k].depth - damping_n_s_m * softness_m_n *
                                                          glm::dot(contact.normal, speed_m_s));
        alone[k] = rows[k].depth / softness_m_n;
        deepest_n = std::max(deepest_n, alone[k]);
    }
    const RowPushes<kMaxRows> solved =
        solve_rows<kMaxRows>(rows, count_, pushing_mask_, kRowSoftness);
    pushing_mask_ = solved.active_mask;
    DofLanes sum{};
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        contacts_[k].push_n = std::min(solved.push[k], kMostPush * (alone[k] + deepest_n));
        for (std::size_t dof = 0; dof < sum.size(); ++dof) {
            sum[dof] +=
                contacts_[k].push_n * rows[k].row[dof] * std::sqrt(settings_.stiffness[dof]);
        }
    }
    wrench_ = of_lanes<Wrench>(sum);
}

void ToolProxy::update(const Tool &tool, ContactScene &scene, const ToolPose &device,
                       const Twist &velocity, double dt_s, ProxyMemory &memory) noexcept {
    queries_ = 0;
    passes_ = 0;
    wrench_ = Wrench();
    given_ = {};
    before_ = contacts_;
    before_count_ = count_;
    count_ = 0;
    if (!all_finite(device.position_m, device.rotation, device.grasp_rad, velocity, dt_s)) {
        return; // nothing is known: nothing pushes, and the proxy waits
    }
    if (!placed_ || scene.count == 0 || tool.count == 0) {
        pose_ = device;
        device_ = device;
        placed_ = true;
        return;
    }
    double left_s = dt_s; // of the scene's motion
    bool again = true;
    for (int pass = 0; pass < kMostPasses && again; ++pass) {
        find_contacts(tool, scene, memory);
        again = step_towards(tool, scene, device, left_s);
        ++passes_;
        for (int s = 0; s < scene.count && left_s > 0.0; ++s) {
            move_on(scene.parts[static_cast<std::size_t>(s)], left_s);
        }
        left_s = 0.0;
    }
    push(tool, scene, velocity);
    rub(tool, scene, device, velocity, dt_s);
    device_ = device;
}

} // namespace spidar
