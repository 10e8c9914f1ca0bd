#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/finite.h"
#include "core/base/sound_state.h"
#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

constexpr int kMostPasses = 3;
// Distance or change per cycle above which a row that stopped the proxy is searched again from
// there. For an edge such a row is only the tangent, which a proxy that slides over a seam must not
// feel.
constexpr double kAnticipated_m = 1e-6;

} // namespace

void ToolProxy::configure(const ProxySettings &settings) noexcept {
    settings_ = settings;
    for (std::size_t dof = 0; dof < settings.stiffness.size(); ++dof) {
        root_[dof] = std::sqrt(settings.stiffness[dof]);
    }
}

void ToolProxy::put(const ToolPose &pose) noexcept {
    const ProxySettings settings = settings_;
    *this = ToolProxy();
    configure(settings);
    pose_ = pose;
    device_ = pose;
    placed_ = true;
}

Move ToolProxy::scaled(const Displacement &by) const noexcept {
    return times(lanes(by), root_);
}

Displacement ToolProxy::unscaled(const Move &move) const noexcept {
    DofLanes row{};
    for (std::size_t dof = 0; dof < row.size(); ++dof) {
        row[dof] = move[dof] / root_[dof];
    }
    return of_lanes<Displacement>(row);
}

Move ToolProxy::unit_move(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m,
                          const Vec3 &direction) const noexcept {
    return over(lanes(moves_along(part, jaws, pose_, point_m, direction)), root_);
}

Move ToolProxy::nearest_to(const Move &target, const Rows &rows,
                           const RowPushes<kMaxRows> &pushes) const noexcept {
    Move move = target;
    for (int i = 0; i < row_count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        add(move, pushes.push[k], rows[k].row);
    }
    return move;
}

double ToolProxy::length_of(const Move &move, const Tool &tool) const noexcept {
    double reach_m = 0.0;
    for (int t = 0; t < tool.count; ++t) {
        const ToolPart &part = tool.parts[static_cast<std::size_t>(t)];
        const double jaw_m =
            part.mount == ToolMount::grip ? 0.0 : 0.5 * tool.jaws.gap_m(pose_.grasp_rad);
        reach_m = std::max(reach_m, glm::length(part.at.origin_m) + jaw_m + part.shape->reach_m());
    }
    const Displacement by = unscaled(move);
    return glm::length(by.linear_m) + reach_m * glm::length(by.angular_rad) +
           0.5 * std::abs(tool.jaws.slope_m_rad() * by.grasp_rad);
}

// Combines two steps that violate no row, so that no step between them does: the move out of the
// way, and a share of the rest.
Move ToolProxy::shortened(const Move &step, const std::array<double, kMaxRows> &least,
                          const Tool &tool, double most_m) const noexcept {
    Rows rows = rows_;
    for (int i = 0; i < row_count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        rows[k].depth = rows[k].depth == kOpen ? kOpen : least[k];
    }
    // When the proxy is inside no row, this is a zero move at no cost.
    Move move = nearest_to(Move{}, rows,
                           solve_rows<kMaxRows>(rows, row_count_, active_mask_, kRowSoftness));
    const double out_m = length_of(move, tool);
    const double shrink = out_m > most_m ? most_m / out_m : 1.0;
    Move rest{};
    for (std::size_t lane = 0; lane < rest.size(); ++lane) {
        move[lane] *= shrink;
        rest[lane] = step[lane] - move[lane];
    }
    const double rest_m = length_of(rest, tool);
    const double part =
        rest_m > 0.0 ? std::clamp((most_m - shrink * out_m) / rest_m, 0.0, 1.0) : 0.0;
    for (std::size_t lane = 0; lane < rest.size(); ++lane) {
        move[lane] += part * rest[lane];
    }
    return move;
}

bool ToolProxy::step_towards(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                             double margin_m, double dt_s, ProxyMemory &memory) noexcept {
    const double most_m = kPartOfMargin * margin_m;
    Move target = scaled(between(pose_, device));
    std::array<double, kMaxRows> least{};
    Move back{}; // to where locked joints belong
    if (tie_.is_tied()) {
        tie_.look(pose_, root_, settings_.damping_s, cycle_s_);
        back = tie_.correction();
        // Joints may contradict each other, or the hand may be far off: the correction per cycle is
        // limited like any other step.
        const double back_m = length_of(back, tool);
        for (double &lane : back) {
            lane *= back_m > most_m ? most_m / back_m : 1.0;
        }
        target = tie_.left(target);
        bent_ = tie_.bend(target);
        add(target, 1.0, bent_);
    }
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const ProxyContact &contact = contacts_[k];
        const ScenePart &other = scene.parts[contact.scene_part];
        const double comes_m =
            dt_s * glm::dot(contact.normal, surface_velocity(other, contact.point_m));
        rows_[k] = ConstraintRow();
        const Move row =
            unit_move(tool.parts[contact.tool_part], tool.jaws, contact.point_m, contact.normal);
        rows_[k].row = row;
        const bool moves = !tie_.is_tied() || tie_.leave(rows_[k].row);
        least[k] = comes_m - contact.gap_m - dot(row, back);
        // A row that only pushes on locked axes is carried by the joint.
        rows_[k].depth = moves ? least[k] - dot(rows_[k].row, target) : kOpen;
    }
    const auto stop = static_cast<std::size_t>(count_);
    row_count_ = count_ + 1;
    for (int i = 0; tie_.is_tied() && i < tie_.limit_count(); ++i) {
        const auto k = static_cast<std::size_t>(row_count_++);
        rows_[k] = ConstraintRow();
        rows_[k].row = tie_.limit_row(i);
        // A coordinate beyond its limit returns no faster than any other step.
        Move whole = rows_[k].row;
        const double per_row = tie_.limit_least(i) / dot(whole, whole);
        for (double &lane : whole) {
            lane *= per_row;
        }
        const double way_m = per_row > 0.0 ? length_of(whole, tool) : 0.0;
        least[k] = tie_.limit_least(i) * (way_m > most_m ? most_m / way_m : 1.0);
        rows_[k].depth = least[k] - dot(rows_[k].row, target);
    }
    rows_[stop] = ConstraintRow();
    rows_[stop].row[kGraspLane] = -1.0 / root_[kGraspLane];
    least[stop] = pose_.grasp_rad - tool.closes_to_rad();
    rows_[stop].depth = least[stop] - dot(rows_[stop].row, target);
    const RowPushes<kMaxRows> solved = solve_over_seams(tool, scene, margin_m, dt_s, memory);
    Move step = nearest_to(target, rows_, solved);
    const bool cut = length_of(step, tool) > most_m;
    if (cut) {
        step = shortened(step, least, tool, most_m);
    }
    bool anticipated = false;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        ProxyContact &contact = contacts_[k];
        if (solved.push[k] > 0.0 && !anticipated) {
            const ProxyContact *last = nearest_before(contact, true);
            anticipated = contact.gap_m > kAnticipated_m ||
                          (passes_ == 0 && last != nullptr &&
                           glm::dot(last->normal, contact.normal) < kTurned);
        }
        contact.gap_m = dot(rows_[k].row, step) - least[k];
    }
    add(step, 1.0, back);
    pose_ = moved(pose_, unscaled(step));
    return cut || anticipated;
}

// Returns how far the tool gives way per newton of a push that its contacts with a part of the
// scene share equally. Two pads that press side by side do not turn the tool, so that it gives way
// less than at one of them.
double ToolProxy::softness_together(const Rows &rows, int scene_part) const noexcept {
    Move sum{};
    int pushing = 0;
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (contacts_[k].scene_part == scene_part && (active_mask_ >> k & 1U) != 0) {
            add(sum, 1.0, rows[k].row);
            ++pushing;
        }
    }
    return pushing > 0 ? dot(sum, sum) / (pushing * pushing) : 0.0;
}

// Computes the pushes that the hand feels, with damping and the compliance of surfaces.
void ToolProxy::push(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                     const Twist &velocity, double dt_s) noexcept {
    const Move pull = scaled(between(device, pose_));
    Rows rows = rows_;
    std::array<int, kMaxSceneParts> touching{};
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        // A row that the step left open would take over from one that a damper releases.
        rows[k].depth = (active_mask_ >> k & 1U) != 0 ? rows[k].depth : kOpen;
        touching[contacts_[k].scene_part] += rows[k].depth > 0.0 ? 1 : 0;
    }
    std::array<double, kMaxRows> alone{};
    double deepest_n = 0.0;
    double deepest = 0.0; // in units of a move
    const auto note_own = [&](std::size_t k) {
        alone[k] = own_push(rows[k]);
        deepest_n = std::max(deepest_n, alone[k]);
        deepest = std::max(deepest, alone[k] * std::sqrt(dot(rows[k].row, rows[k].row)));
    };
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        ProxyContact &contact = contacts_[k];
        const ScenePart &other = scene.parts[contact.scene_part];
        if (!(rows[k].depth > 0.0)) {
            continue;
        }
        const double softness_m_n = other.stiffness_n_m > 0.0
                                        ? softness_together(rows, contact.scene_part)
                                        : dot(rows[k].row, rows[k].row);
        double more_m_n = 0.0; // by which the surface gives way beside the tool
        if (other.stiffness_n_m > 0.0) {
            more_m_n = std::max(0.0, 1.0 / other.stiffness_n_m - softness_m_n);
            rows[k].compliance = more_m_n * touching[contact.scene_part];
        }
        const Vec3 speed_m_s = point_velocity(tool.parts[contact.tool_part], tool.jaws, pose_,
                                              velocity, contact.point_m) -
                               surface_velocity(other, contact.point_m);
        const double damping_s =
            settings_.damping_s + other.damping_n_s_m * (softness_m_n + more_m_n);
        const double height_m = other.traits.texture.depth_m > 0.0
                                    ? press_into(contact, other, own_push(rows[k]), speed_m_s, dt_s)
                                    : 0.0;
        // The damper and the texture act as a deeper spring, so that the push stays one-sided and
        // is shared.
        rows[k].depth = std::max(0.0, rows[k].depth + height_m -
                                          damping_s * glm::dot(contact.normal, speed_m_s));
        note_own(k);
    }
    const auto stop = static_cast<std::size_t>(count_);
    if (rows[stop].depth > 0.0) {
        rows[stop].depth =
            std::max(0.0, rows[stop].depth + settings_.damping_s * velocity.grasp_rate_rad_s);
        note_own(stop);
    }
    for (std::size_t k = stop + 1; k < static_cast<std::size_t>(row_count_); ++k) {
        // A joint's limit is damped like a contact.
        const double speed = dot(rows[k].row, times(lanes(velocity), root_));
        if (rows[k].depth > 0.0) {
            rows[k].depth = std::max(0.0, rows[k].depth - settings_.damping_s * speed);
            note_own(k);
        }
    }
    const RowPushes<kMaxRows> solved =
        solve_rows<kMaxRows>(rows, row_count_, pushing_mask_, kRowSoftness);
    pushing_mask_ = solved.active_mask;
    // Where no pose satisfies all rows, the pushes are unlimited: the sum is limited relative to
    // the pull.
    const Move pushed = nearest_to(Move{}, rows, solved);
    const double pushed_by = std::sqrt(dot(pushed, pushed));
    const double most = kMostPush * (std::sqrt(dot(pull, pull)) + deepest);
    const double part = pushed_by > most ? most / pushed_by : 1.0;
    DofLanes sum{};
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] = part * pushed[dof] * root_[dof];
    }
    // Each push is limited too, for a wedge of less than some 20 degrees and two walls that are too
    // near.
    const auto alone_too = [&](std::size_t k) {
        return std::min(part * solved.push[k], kMostPush * (alone[k] + deepest_n));
    };
    stop_push_nm_ = alone_too(stop);
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        contacts_[k].push_n = alone_too(k);
    }
    wrench_ = of_lanes<Wrench>(sum);
    if (tie_.is_tied()) {
        add_joints(pull, pushed, velocity);
    }
}

void ToolProxy::follow(const ToolPose &device) noexcept {
    if (!idle_) {
        wrench_ = Wrench();
        given_ = {};
        stop_push_nm_ = 0.0;
        before_count_ = 0;
        count_ = 0;
        active_mask_ = 0;
        pushing_mask_ = 0;
        idle_ = true;
    }
    pose_ = device;
    device_ = device;
    placed_ = true;
}

void ToolProxy::update(const Tool &tool, ContactScene &scene, const ToolPose &device,
                       const Twist &velocity, double dt_s, ProxyMemory &memory) noexcept {
    queries_ = 0;
    passes_ = 0;
    const bool known =
        all_finite(device.position_m, device.rotation, device.grasp_rad, velocity, dt_s);
    const bool open = device.grasp_rad <= tool.closes_to_rad();
    const bool alone = (scene.count == 0 || tool.count == 0) && open && !tie_.is_tied();
    if (known && (!placed_ || alone)) {
        follow(device);
    }
    if (known && alone) {
        return;
    }
    idle_ = false;
    wrench_ = Wrench();
    given_ = {};
    stop_push_nm_ = 0.0;
    before_ = contacts_;
    before_count_ = count_;
    count_ = 0;
    if (!known) {
        return; // nothing pushes: the proxy stays
    }
    has_traits_ = std::any_of(scene.parts.begin(), scene.parts.begin() + scene.count,
                              [](const ScenePart &part) { return acts(part.traits); });
    const double margin_m = margin_for(scene, dt_s);
    cycle_s_ = dt_s;
    if (tie_.is_tied()) {
        tie_.advance(dt_s);
    }
    double left_s = dt_s; // remaining time of the scene's motion
    bool again = true;
    for (int pass = 0; pass < kMostPasses && again; ++pass) {
        find_contacts(tool, scene, margin_m, memory);
        again = step_towards(tool, scene, device, margin_m, left_s, memory);
        ++passes_;
        for (int s = 0; s < scene.count && left_s > 0.0; ++s) {
            ScenePart &part = scene.parts[static_cast<std::size_t>(s)];
            carry_on(part.at, part.velocity_m_s, part.angular_rad_s, left_s);
        }
        left_s = 0.0;
    }
    push(tool, scene, device, velocity, dt_s);
    rub(tool, scene, device, velocity, dt_s);
    if (has_traits_) {
        act_by_traits(tool, scene);
    }
    device_ = device;
    tie_.settle(pose_);
}

bool ToolProxy::is_sound() const noexcept {
    const auto points_to_parts = [](const Contacts &contacts, int count) {
        bool sound = count >= 0 && count <= kMaxPoints;
        for (int i = 0; sound && i < count; ++i) {
            const ProxyContact &contact = contacts[static_cast<std::size_t>(i)];
            sound = contact.tool_part < kMaxToolParts && contact.scene_part < kMaxSceneParts &&
                    are_flags(contact.rubs, contact.sticks);
        }
        return sound;
    };
    return are_flags(placed_, idle_, has_traits_) && points_to_parts(contacts_, count_) &&
           points_to_parts(before_, before_count_) && tie_.is_sound() && row_count_ >= 0 &&
           row_count_ <= kMaxRows;
}

} // namespace spidar
