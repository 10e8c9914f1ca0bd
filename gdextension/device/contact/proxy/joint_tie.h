// The joints of a tool: which moves of the proxy they allow, and the springs, dampers and motors
// along those moves. A locked axis is not one of the rows that push (god_object.h). Instead, the
// proxy is restricted to moves that keep the axis locked, so that no push opens the joint. Springs,
// dampers and motors are solved implicitly, so that they are stable however stiff or fast they are.
#pragma once

#include <array>

#include "device/contact/god_object.h"
#include "device/contact/proxy/move.h"
#include "device/contact/proxy/tool.h"
#include "device/contact/proxy/tool_joint.h"

namespace spidar {

inline constexpr int kMaxTieRows = 6 * kMaxToolJoints;

class JointTie {
public:
    // Takes the joints of a new scene and moves their bases on by later_s. If a joint was in the
    // last scene too, its jump relative to that scene is corrected gradually.
    void accept(const Tool &tool, double later_s, const ToolPose &pose) noexcept;
    [[nodiscard]] bool is_tied() const noexcept { return count_ > 0; }
    // Moves the joints' bases to the end of this cycle. Called once per cycle.
    void advance(double dt_s) noexcept;
    // Computes locked axes, limits and forces of the joints at this pose. root: square roots of the
    // stiffnesses between device and proxy. damping_s: ProxySettings::damping_s. A spring is damped
    // by at least its stiffness * damping_s * kSpringDamping (joint_tie.cpp): the link's latency
    // would let an undamped spring add more energy.
    void look(const ToolPose &pose, const Move &root, double damping_s, double dt_s) noexcept;
    // Stores the joints' coordinates at the end of the cycle.
    void settle(const ToolPose &pose) noexcept;

    // Returns the part of a move that the joints allow.
    [[nodiscard]] Move left(const Move &move) const noexcept;
    // Replaces a row by the part that the joints allow. Returns false if less than a thousandth of
    // its squared length is left.
    [[nodiscard]] bool leave(Move &row) const noexcept;
    // Returns the part of a move that the joints lock.
    [[nodiscard]] Move locked(const Move &move) const noexcept;
    // The move that brings the locked axes to their targets.
    [[nodiscard]] const Move &correction() const noexcept { return correction_; }
    // Returns the move by which springs, dampers and motors displace the proxy from `target`.
    [[nodiscard]] Move bend(const Move &target) const noexcept;
    // Velocity of the locked axes with their bases, as a move per second.
    [[nodiscard]] const Move &carried() const noexcept { return carried_; }

    // Limit i of the joints requires limit_row(i) . move >= limit_least(i) of the move that is made
    // besides correction().
    [[nodiscard]] int limit_count() const noexcept { return limit_count_; }
    [[nodiscard]] const Move &limit_row(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].row;
    }
    [[nodiscard]] double limit_least(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].least;
    }
    // Coordinate `axis` (0 to 5) of the first joint, for tests.
    [[nodiscard]] double coordinate(int axis) const noexcept {
        return states_[0].at[static_cast<std::size_t>(axis)];
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept;

private:
    using Coordinates = std::array<double, 6>;
    struct State {
        ToolJoint joint;
        Coordinates at{}; // at the end of the last cycle
        // Remaining offset of locked axes from when the joint was grasped or jumped; it decays.
        Coordinates slack{};
        // Present stiffness of the springs, which changes gradually.
        Coordinates stiffness{};
        bool begun = false;
    };
    struct Limit {
        Move row{};
        double least = 0.0;
    };
    struct Force {
        JointAxis axis;
        Move row{};
        double now = 0.0;    // the coordinate after correction()
        double before = 0.0; // at the end of the last cycle
    };

    // near: coordinates of the last cycle, from which a hinge's angle continues beyond half a turn.
    [[nodiscard]] static Coordinates coordinates_of(const ToolJoint &joint, const ToolPose &pose,
                                                    const Coordinates &near) noexcept;
    void look_at(State &state, const ToolPose &pose, const Move &root) noexcept;
    void lock(Move row, double least, double carried) noexcept;

    std::array<State, kMaxToolJoints> states_{};
    int count_ = 0;
    std::array<Move, kMaxTieRows> locked_{}; // orthonormal
    int locked_count_ = 0;
    Move correction_{};
    Move carried_{};
    std::array<Limit, kMaxLimits> limits_{};
    int limit_count_ = 0;
    std::array<Force, kMaxTieRows> forces_{};
    int force_count_ = 0;
    double least_damping_s_ = 0.0;
    double dt_s_ = 0.0;
};

} // namespace spidar
