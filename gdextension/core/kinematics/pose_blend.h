// From one answer of the kinematics to another without a jump: the pose shown goes there in equal parts, while the hand
// moves on.
#pragma once

#include "core/base/sound_state.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

class PoseBlend {
public:
    // The farthest point moves by this in a tick at most, unless the whole then takes longer than kLongest.
    static constexpr double kStep_m = 0.8e-3;
    static constexpr int kLongest_ticks = 130;

    void stop() noexcept { left_ = 0; }
    [[nodiscard]] bool active() const noexcept { return left_ > 0; }
    // Shown so far, found now.
    void start(const GripPose &shown, const GripPose &found) noexcept;
    // Once a tick, with the newest pose found. Returns the pose to show.
    GripPose next(const GripPose &found) noexcept;
    [[nodiscard]] const GripPose &shown() const noexcept { return shown_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return left_ >= 0 && left_ <= kLongest_ticks; }

private:
    int left_ = 0;
    GripPose shown_{};
    GripPose found_{}; // in the tick before
};

} // namespace spidar
