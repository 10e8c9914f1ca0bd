// The joints of a tool in the proxy's problem: the moves that they leave, and the springs, dampers and motors along those.
// A locked axis is no row that the solver weighs: the problem is taken to the moves that keep it, so that it holds
// exactly, at any push. Springs, dampers and motors are solved implicitly: none of them is too stiff or too fast for a servo
// cycle, and none gives energy beyond a motor's own.
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
    // The joints of a new scene, as they will be in later_s. What the same joint is corrected by since the last scene is
    // given back slowly.
    void accept(const Tool &tool, double later_s, const ToolPose &pose) noexcept;
    [[nodiscard]] bool is_tied() const noexcept { return count_ > 0; }
    // Once a cycle: where the joints' other bodies are at its end.
    void advance(double dt_s) noexcept;
    // What the joints leave at this pose. root: of the stiffnesses. damping_s: of contacts. A spring is damped by at
    // least kSpringDamping of that, in parts of its stiffness: without any, the link's latency would let it give energy.
    void look(const ToolPose &pose, const Move &root, double damping_s, double dt_s) noexcept;
    // The coordinates at the end of the cycle.
    void settle(const ToolPose &pose) noexcept;

    // Of a move, the part that the joints leave.
    [[nodiscard]] Move left(const Move &move) const noexcept;
    // The same of a row of the problem. False: the joints leave nothing of it but rounding, so no move can do anything about it.
    [[nodiscard]] bool leave(Move &row) const noexcept;
    // The part that they lock.
    [[nodiscard]] Move locked(const Move &move) const noexcept;
    // What brings the tool back to where locked axes belong.
    [[nodiscard]] const Move &correction() const noexcept { return correction_; }
    // How far springs, dampers and motors move a target, which lies in what is left.
    [[nodiscard]] Move bend(const Move &target) const noexcept;
    // How fast the other bodies carry the locked axes along.
    [[nodiscard]] const Move &carried() const noexcept { return carried_; }

    // The limits: row . move >= least for a move in what is left, beside the correction.
    [[nodiscard]] int limit_count() const noexcept { return limit_count_; }
    [[nodiscard]] const Move &limit_row(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].row;
    }
    [[nodiscard]] double limit_least(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].least;
    }
    // Coordinates of the first joint, for tests and reports.
    [[nodiscard]] double coordinate(int axis) const noexcept {
        return states_[0].at[static_cast<std::size_t>(axis)];
    }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept;

private:
    using Coordinates = std::array<double, 6>;
    struct State {
        ToolJoint joint;
        Coordinates at{};        // at the end of the last cycle
        Coordinates slack{};     // what is left of where it was off when it was caught or corrected
        Coordinates stiffness{}; // of the springs now: they come and change gradually
        bool begun = false;
    };
    struct Limit {
        Move row{};
        double least = 0.0;
    };
    struct Force {
        JointAxis axis;
        Move row{};
        double now = 0.0;    // the coordinate, with the correction
        double before = 0.0; // at the end of the last cycle
    };

    // near: of the last cycle, for turns beyond half a one.
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
