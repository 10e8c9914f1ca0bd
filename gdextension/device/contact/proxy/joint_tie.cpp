#include "device/contact/proxy/joint_tie.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/sound_state.h"
#include "core/geometry/rotation_log.h"
#include "device/contact/proxy/row_forces.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Time over which the offset of a joint that was just grasped is corrected. The physics engine
// holds joints to a fraction of a millimeter, and correcting that at once would be felt as a jolt.
constexpr double kGivesBack_s = 0.1;
// Time over which a spring appears, disappears or changes.
constexpr double kSpringTime_s = 0.02;
// Smallest independent part of a row of unit stiffness; below it the row repeats others, as with
// two hinges of one door. A remainder this small (2 degrees) would turn a slight contradiction of
// two joints into a large move.
constexpr double kDependent = 1e-3;
// Damping of springs relative to the damping time. With 1, a knob that is turned at random for ten
// minutes at 1 ms latency and 1 kHz adds 0.04 J, without damping 0.29 J.
constexpr double kSpringDamping = 1.5;

// Returns the only axis about which the joint turns; -1 for none or several.
int hinge_axis(const ToolJoint &joint) noexcept {
    int found = -1;
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!joint.axes[3 + static_cast<std::size_t>(axis)].is_locked()) {
            found = axis;
            ++count;
        }
    }
    return count == 1 ? found : -1;
}

// Returns row i of d(rotation vector) / d(turn), with the turn along the base's axes.
Vec3 log_row(const Vec3 &log, int i) noexcept {
    Vec3 unit(0.0);
    unit[i] = 1.0;
    const double angle = glm::length(log);
    constexpr double kSmall = 1e-4;
    const double factor = angle < kSmall
                              ? 1.0 / 12.0
                              : 1.0 / (angle * angle) - 1.0 / (2.0 * angle * std::tan(0.5 * angle));
    // The transpose of I - [log] / 2 + factor [log]^2.
    return unit + 0.5 * glm::cross(log, unit) + factor * glm::cross(log, glm::cross(log, unit));
}

void move_on(ToolJoint &joint, double dt_s) noexcept {
    carry_on(joint.base, joint.velocity_m_s, joint.angular_rad_s, dt_s);
}

} // namespace

JointTie::Coordinates JointTie::coordinates_of(const ToolJoint &joint, const ToolPose &pose,
                                               const Coordinates &near) noexcept {
    const Placement tool = Placement{pose.position_m, pose.rotation} * joint.in_grip;
    const Mat3 to_base = glm::transpose(joint.base.rotation);
    const Vec3 apart_m = to_base * (tool.origin_m - joint.base.origin_m);
    const Mat3 turn = to_base * tool.rotation;
    const int hinge = hinge_axis(joint);
    Vec3 turns(0.0);
    if (hinge >= 0) {
        const int next = (hinge + 1) % 3;
        const int last = (hinge + 2) % 3;
        // The inclination of the joint's axis.
        Vec3 unit(0.0);
        unit[hinge] = 1.0;
        turns = rotation_between(unit, turn[hinge]);
        const double angle = std::atan2(turn[next][last], turn[next][next]);
        const double whole = 2.0 * std::numbers::pi;
        turns[hinge] =
            angle + whole * std::round((near[3 + static_cast<std::size_t>(hinge)] - angle) / whole);
    } else {
        turns = rotation_log(turn);
    }
    return {apart_m.x, apart_m.y, apart_m.z, turns.x, turns.y, turns.z};
}

void JointTie::accept(const Tool &tool, double later_s, const ToolPose &pose) noexcept {
    const std::array<State, kMaxToolJoints> old = states_;
    const int old_count = count_;
    count_ = tool.joint_count;
    for (int j = 0; j < count_; ++j) {
        const auto k = static_cast<std::size_t>(j);
        State &state = states_[k];
        state = State();
        state.joint = tool.joints[k];
        move_on(state.joint, later_s);
        const auto *const end = old.data() + old_count;
        const auto *const before = std::find_if(old.data(), end, [&state](const State &one) {
            return one.joint.id == state.joint.id && one.begun;
        });
        if (before == end) {
            continue;
        }
        const Coordinates was = coordinates_of(before->joint, pose, before->at);
        const Coordinates now = coordinates_of(state.joint, pose, before->at);
        state.begun = true;
        state.stiffness = before->stiffness;
        for (std::size_t axis = 0; axis < now.size(); ++axis) {
            const bool locked = state.joint.axes[axis].is_locked();
            state.slack[axis] = locked ? before->slack[axis] + now[axis] - was[axis] : 0.0;
            state.at[axis] = before->at[axis] + now[axis] - was[axis];
        }
    }
}

void JointTie::advance(double dt_s) noexcept {
    const double kept = std::exp(-dt_s / kGivesBack_s);
    const double stays = std::exp(-dt_s / kSpringTime_s);
    for (int j = 0; j < count_; ++j) {
        State &state = states_[static_cast<std::size_t>(j)];
        move_on(state.joint, dt_s);
        for (std::size_t axis = 0; axis < state.slack.size(); ++axis) {
            const double wanted = state.joint.axes[axis].stiffness;
            state.slack[axis] *= kept;
            state.stiffness[axis] = wanted + stays * (state.stiffness[axis] - wanted);
        }
    }
}

// Locks a row besides those that are locked already.
void JointTie::lock(Move row, double least, double carried) noexcept {
    const double whole = dot(row, row);
    for (int i = 0; i < locked_count_; ++i) {
        const Move &other = locked_[static_cast<std::size_t>(i)];
        const double share = dot(row, other);
        add(row, -share, other);
        least -= share * dot(correction_, other);
        carried -= share * dot(carried_, other);
    }
    const double own = dot(row, row);
    if (!(own > kDependent * whole) || locked_count_ == kMaxTieRows) {
        return;
    }
    const double length = std::sqrt(own);
    for (double &lane : row) {
        lane /= length;
    }
    add(correction_, least / length, row);
    add(carried_, carried / length, row);
    locked_[static_cast<std::size_t>(locked_count_++)] = row;
}

void JointTie::look_at(State &state, const ToolPose &pose, const Move &root) noexcept {
    const ToolJoint &joint = state.joint;
    const Coordinates now = coordinates_of(joint, pose, state.at);
    if (!state.begun) {
        state.begun = true;
        state.at = now;
        for (std::size_t axis = 0; axis < now.size(); ++axis) {
            const JointAxis &rule = joint.axes[axis];
            state.slack[axis] = rule.is_locked() ? now[axis] - rule.lower : 0.0;
        }
    }
    const Placement tool = Placement{pose.position_m, pose.rotation} * joint.in_grip;
    const Vec3 lever_m = tool.origin_m - pose.position_m;
    const bool turns_freely = hinge_axis(joint) < 0;
    const Vec3 log(now[3], now[4], now[5]);
    for (std::size_t axis = 0; axis < now.size(); ++axis) {
        const bool is_turn = axis >= 3;
        const int k = static_cast<int>(axis % 3);
        const Vec3 direction = is_turn && turns_freely ? joint.base.rotation * log_row(log, k)
                                                       : joint.base.rotation[k];
        const Vec3 linear = is_turn ? Vec3(0.0) : direction;
        const Vec3 angular = is_turn ? direction : glm::cross(lever_m, direction);
        const Move row = over(lanes(linear, angular, 0.0), root);
        const JointAxis &rule = joint.axes[axis];
        if (rule.is_locked()) {
            const Vec3 there_m_s =
                joint.velocity_m_s +
                glm::cross(joint.angular_rad_s, tool.origin_m - joint.base.origin_m);
            const double carried = glm::dot(direction, is_turn ? joint.angular_rad_s : there_m_s);
            lock(row, rule.lower + state.slack[axis] - now[axis], carried);
            continue;
        }
        Force &force = forces_[static_cast<std::size_t>(force_count_++)];
        force = {rule, row, now[axis], state.at[axis]};
        force.axis.stiffness = state.stiffness[axis];
    }
}

void JointTie::look(const ToolPose &pose, const Move &root, double damping_s,
                    double dt_s) noexcept {
    least_damping_s_ = kSpringDamping * damping_s;
    dt_s_ = dt_s;
    locked_count_ = 0;
    correction_ = {};
    carried_ = {};
    limit_count_ = 0;
    force_count_ = 0;
    for (int j = 0; j < count_; ++j) {
        look_at(states_[static_cast<std::size_t>(j)], pose, root);
    }
    // All locked rows are known now: the others act in the remaining moves.
    for (int i = 0; i < force_count_; ++i) {
        Force &force = forces_[static_cast<std::size_t>(i)];
        force.now += dot(force.row, correction_);
        if (!leave(force.row)) {
            force.row = {};
            continue;
        }
        const JointAxis &rule = force.axis;
        if (rule.is_limited() && limit_count_ < kMaxLimits) {
            // Uses the nearer end.
            const bool low = force.now - rule.lower < rule.upper - force.now;
            Limit &limit = limits_[static_cast<std::size_t>(limit_count_++)];
            limit = {};
            add(limit.row, low ? 1.0 : -1.0, force.row);
            limit.least = low ? rule.lower - force.now : force.now - rule.upper;
        }
    }
}

void JointTie::settle(const ToolPose &pose) noexcept {
    for (int j = 0; j < count_; ++j) {
        State &state = states_[static_cast<std::size_t>(j)];
        state.at = coordinates_of(state.joint, pose, state.at);
    }
}

Move JointTie::locked(const Move &move) const noexcept {
    Move part{};
    for (int i = 0; i < locked_count_; ++i) {
        const Move &row = locked_[static_cast<std::size_t>(i)];
        add(part, dot(row, move), row);
    }
    return part;
}

Move JointTie::left(const Move &move) const noexcept {
    Move part = move;
    add(part, -1.0, locked(move));
    return part;
}

bool JointTie::leave(Move &row) const noexcept {
    const double whole = dot(row, row);
    row = left(row);
    return dot(row, row) > kDependent * whole;
}

Move JointTie::bend(const Move &target) const noexcept {
    RowForces forces;
    for (int i = 0; i < force_count_; ++i) {
        const Force &force = forces_[static_cast<std::size_t>(i)];
        const JointAxis &rule = force.axis;
        const double there = force.now + dot(force.row, target);
        const double damping = std::max(rule.damping, least_damping_s_ * rule.stiffness) / dt_s_;
        const double stiffness = rule.stiffness + damping;
        if (stiffness > 0.0) {
            const double wanted = (rule.stiffness * rule.rest + damping * force.before) / stiffness;
            forces.add(force.row, wanted - there, 1.0 / stiffness);
        }
        if (rule.motor_most > 0.0) {
            forces.add(force.row, force.before + rule.motor_speed * dt_s_ - there, 0.0,
                       rule.motor_most);
        }
    }
    return forces.solve();
}

bool JointTie::is_sound() const noexcept {
    const auto within = [](int count, int most) { return count >= 0 && count <= most; };
    return within(count_, kMaxToolJoints) && within(locked_count_, kMaxTieRows) &&
           within(limit_count_, kMaxLimits) && within(force_count_, kMaxTieRows) &&
           std::ranges::all_of(states_, [](const State &state) { return are_flags(state.begun); });
}

} // namespace spidar
