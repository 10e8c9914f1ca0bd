// Determines from the grasp angle whether the grip is open, grasped or over-closed. Hysteresis and
// a dwell time reject noise.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/sound_state.h"

namespace spidar {

inline constexpr double kDegree_rad = 0.017453292519943295;

enum class GraspPhase : std::uint8_t { open = 0, grasped = 1, over_closed = 2 };

// Thresholds on grasp_angle (0 at rest). The paper grasps between 20 and 50 degrees and does not
// state its zero.
struct GraspSettings {
    double enter_rad = 20.0 * kDegree_rad;
    double leave_rad = 15.0 * kDegree_rad;
    double over_closed_rad = 55.0 * kDegree_rad;
    double over_closed_leave_rad = 50.0 * kDegree_rad;
    // Time for which the angle must belong to a new phase before the phase changes.
    double dwell_s = 0.030;
};

class GraspDetector {
public:
    void configure(const GraspSettings &settings) noexcept { settings_ = settings; }
    // Returns the phase. dt_s: time since the last call. A non-finite grasp angle changes nothing.
    GraspPhase update(double grasp_angle_rad, double dt_s) noexcept;
    [[nodiscard]] GraspPhase phase() const noexcept { return phase_; }
    // True when no change of phase waits for its dwell.
    [[nodiscard]] bool at_rest() const noexcept { return candidate_ == phase_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return is_one_of(phase_, GraspPhase::over_closed) &&
               is_one_of(candidate_, GraspPhase::over_closed);
    }

private:
    GraspSettings settings_{};
    GraspPhase phase_ = GraspPhase::open;
    GraspPhase candidate_ = GraspPhase::open;
    double candidate_age_s_ = 0.0;
};

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const GraspSettings &settings);

} // namespace spidar
