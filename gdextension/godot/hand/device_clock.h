// The device's time between the physics ticks of a hand. Forces, impulses and velocities of a device are in its own time: it
// goes on when Engine.time_scale slows the game, and stands still between physics ticks that share one drawn frame.
#pragma once

#include <algorithm>
#include <limits>

namespace spidar {

class DeviceClock {
public:
    // Once a physics tick of tick_s. now_s: the device's time.
    void read(double now_s, double tick_s) noexcept {
        if (!known_) {
            read_s_ = now_s;
            known_ = true;
        }
        apart_s_ = std::clamp(apart_s_, tick_s, std::max(tick_s, kLongest_s));
        elapsed_s_ = now_s - read_s_;
        if (!(elapsed_s_ >= kLeastPart * apart_s_)) {
            elapsed_s_ = 0.0;
            return;
        }
        read_s_ = now_s;
        apart_s_ = elapsed_s_;
    }
    // Device time between the pose that this tick reads and the last one that was read, s; 0: it is still the same pose.
    [[nodiscard]] double elapsed_s() const noexcept { return elapsed_s_; }

private:
    // Two poses count as one when they are nearer in time than this part of the last interval, or of a physics tick. Ticks that
    // share a drawn frame are some milliseconds apart, and differences over so short a time are mostly noise.
    static constexpr double kLeastPart = 0.5;
    // The device fades scenes that are older than this.
    static constexpr double kLongest_s = 0.1;

    bool known_ = false;
    double read_s_ = 0.0;
    double apart_s_ = 0.0;
    double elapsed_s_ = 0.0;
};

} // namespace spidar
