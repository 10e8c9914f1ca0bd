// Measures the device time between a hand's physics ticks, to which forces, impulses and velocities
// refer. Device time continues at full speed when Engine.time_scale slows the game. Of physics
// ticks that share a drawn frame, only the first one gets a new interval.
#pragma once

#include <algorithm>
#include <limits>

namespace spidar {

class DeviceClock {
public:
    // Called once per physics tick. now_s: device time. tick_s: length of a physics tick.
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
    // Device time between this tick and the last one with a new interval (unit: s). 0: the pose of
    // this tick counts as the same as before.
    [[nodiscard]] double elapsed_s() const noexcept { return elapsed_s_; }

private:
    // Two poses count as one when their times differ by less than this share of the last interval
    // or of a physics tick. Ticks that share a drawn frame are milliseconds apart, and differences
    // over so short a time are mostly noise.
    static constexpr double kLeastPart = 0.5;
    // Longest interval to which kLeastPart refers (unit: s): the device fades older scenes.
    static constexpr double kLongest_s = 0.1;

    bool known_ = false;
    double read_s_ = 0.0;
    double apart_s_ = 0.0;
    double elapsed_s_ = 0.0;
};

} // namespace spidar
