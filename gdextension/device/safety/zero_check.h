// Checks a zero: was it taken at home, with the strings in their places? One pose cannot show it,
// since the counts of any pose can be declared to be home. Once the grip moves, a wrong zero,
// swapped or reversed strings make the lengths contradict each other.
#pragma once

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/sound_state.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

class ZeroCheck {
public:
    enum class Verdict : std::uint8_t { pending, confirmed, refused };

    // Distance from home that the grip must reach (unit: m).
    static constexpr double kReach_m = 0.040;
    // Path that the grip must travel (unit: m).
    static constexpr double kTravel_m = 0.150;
    // Parity error that refuses the zero (unit: m). A zero 30 mm beside home gives 2 mm within
    // kReach_m, a calibrated device 0.5 mm.
    static constexpr double kParity_m = 0.001;
    // Time for which the error must last (unit: s), so that one bad sample does not refuse the
    // zero.
    static constexpr double kHold_s = 0.020;

    void begin() noexcept {
        *this = ZeroCheck();
        running_ = true;
    }
    void end() noexcept { running_ = false; }
    [[nodiscard]] bool at_rest() const noexcept { return !running_; }
    Verdict update(const GripPose &pose, double parity_m, double dt_s) noexcept {
        if (!started_) {
            started_ = true;
            home_m_ = pose.position_m;
            last_m_ = pose.position_m;
        }
        travel_m_ += glm::distance(pose.position_m, last_m_);
        last_m_ = pose.position_m;
        reach_m_ = std::max(reach_m_, glm::distance(pose.position_m, home_m_));
        worst_m_ = std::max(worst_m_, parity_m);
        wrong_s_ = !(parity_m <= kParity_m) ? wrong_s_ + dt_s : 0.0; // NaN is wrong
        if (wrong_s_ >= kHold_s) {
            return Verdict::refused;
        }
        return reach_m_ >= kReach_m && travel_m_ >= kTravel_m ? Verdict::confirmed
                                                              : Verdict::pending;
    }
    [[nodiscard]] double worst_m() const noexcept { return worst_m_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(running_, started_); }

private:
    bool running_ = false;
    bool started_ = false;
    Vec3 home_m_{0.0};
    Vec3 last_m_{0.0};
    double reach_m_ = 0.0;
    double travel_m_ = 0.0;
    double worst_m_ = 0.0;
    double wrong_s_ = 0.0;
};

} // namespace spidar
