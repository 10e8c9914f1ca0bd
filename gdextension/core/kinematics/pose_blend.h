// Moves the shown pose to another pose that was found, without a jump and in equal steps, while the
// hand moves on.
#pragma once

#include "core/base/sound_state.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

class PoseBlend {
public:
    // Largest movement of the fastest point per tick, besides the hand's motion. A blend that would
    // take more than kLongest_ticks moves faster.
    static constexpr double kStep_m = 0.8e-3;
    static constexpr int kLongest_ticks = 130;

    void stop() noexcept { left_ = 0; }
    [[nodiscard]] bool active() const noexcept { return left_ > 0; }
    // Starts a blend from the pose shown so far to the pose found now.
    void start(const GripPose &shown, const GripPose &found) noexcept;
    // Takes one tick with the newest found pose. Returns the pose to show.
    GripPose next(const GripPose &found) noexcept;
    [[nodiscard]] const GripPose &shown() const noexcept { return shown_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return left_ >= 0 && left_ <= kLongest_ticks; }

private:
    // Number of ticks until the shown pose reaches the found one.
    int left_ = 0;
    GripPose shown_{};
    GripPose found_{}; // the found pose of the previous tick
};

} // namespace spidar
