// The joints of a tool in the proxy's problem: the moves that they allow, and the springs, dampers
// and motors along these. A locked axis is not a weighted row: the problem is restricted to the
// moves that keep the axis locked, so that it holds exactly under any push. Springs, dampers and
// motors are solved implicitly: none is too stiff or too fast for a servo cycle, and only motors
// add energy.
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
    // Takes the joints of a new scene, as they will be in later_s. The correction of a known joint
    // since the last scene is applied slowly.
    void accept(const Tool &tool, double later_s, const ToolPose &pose) noexcept;
    [[nodiscard]] bool is_tied() const noexcept { return count_ > 0; }
    // Moves the joints' bases to the end of this cycle. Called once per cycle.
    void advance(double dt_s) noexcept;
    // Computes what the joints allow at this pose. root: square root of the stiffnesses. damping_s:
    // damping time of contacts. A spring is damped by at least kSpringDamping of that time: without
    // damping the link's latency would let it add energy.
    void look(const ToolPose &pose, const Move &root, double damping_s, double dt_s) noexcept;
    // Stores the coordinates at the end of the cycle.
    void settle(const ToolPose &pose) noexcept;

    // Returns the part of a move that the joints allow.
    [[nodiscard]] Move left(const Move &move) const noexcept;
    // Projects a row likewise. Returns false when no move affects the row, to within rounding.
    [[nodiscard]] bool leave(Move &row) const noexcept;
    // Returns the part of a move that the joints lock.
    [[nodiscard]] Move locked(const Move &move) const noexcept;
    // The move that brings the locked axes back to their targets.
    [[nodiscard]] const Move &correction() const noexcept { return correction_; }
    // Returns how far springs, dampers and motors shift a target within the allowed moves.
    [[nodiscard]] Move bend(const Move &target) const noexcept;
    // The move of the locked axes with the bases in this cycle.
    [[nodiscard]] const Move &carried() const noexcept { return carried_; }

    // Limits of the joints: row . move >= least, for an allowed move besides the correction.
    [[nodiscard]] int limit_count() const noexcept { return limit_count_; }
    [[nodiscard]] const Move &limit_row(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].row;
    }
    [[nodiscard]] double limit_least(int i) const noexcept {
        return limits_[static_cast<std::size_t>(i)].least;
    }
    // A coordinate of the first joint, for tests and reports.
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
        // Remaining offset from when the joint was grasped or corrected.
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
        double now = 0.0;    // the coordinate, with the correction
        double before = 0.0; // at the end of the last cycle
    };

    // near: coordinates of the last cycle, for turns beyond half a turn.
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
