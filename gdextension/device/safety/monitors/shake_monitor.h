// Do the forces shake the grip? A rendering that is too stiff for its latency swings to and fro at 8 to 200 Hz;
// a hand does not, and a tap swings once or twice. Counted are the swings that follow each other within half a period:
// of the grip's velocity, in each DOF, and of what the contacts push, where a firm hand hardly moves.
#pragma once

#include "core/base/sound_state.h"
#include "core/base/types.h"

namespace spidar {

class ShakeMonitor {
public:
    void configure() noexcept { *this = ShakeMonitor(); }
    // One cycle. push: of all contacts on the grip. `rendering`: forces act; without them nothing counts.
    void update(const Twist &twist, const Wrench &push, bool rendering, double dt_s) noexcept;

    // Shaking that another monitor found: counts as if it had been found here. swing_m_s: its largest swing.
    void found(double swing_m_s) noexcept;

    // 1; halved each time the grip is found shaking, back to 1 when it was calm for kCalm_s.
    [[nodiscard]] double scale() const noexcept { return scale_; }
    // Still shaking after two halvings: forces have to go. Until configure() or calm.
    [[nodiscard]] bool unstable() const noexcept { return unstable_; }
    // Largest swing of the shaking that was found last (unit: m/s at the pole ends).
    [[nodiscard]] double swing_m_s() const noexcept { return swing_m_s_; }

    // Full scale, and nothing changes any more while the grip rests.
    [[nodiscard]] bool at_rest() const noexcept;

    static constexpr double kCalm_s = 2.0;
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(unstable_); }

private:
    struct Kind {
        double least;          // that counts as a swing
        double longest_half_s; // from a swing to the next of the same row
        double slow_s;         // time constant of the slow part
    };
    static const Kind kSpeed; // m/s at the pole ends
    static const Kind kPush;  // N
    struct Channel {
        // One cycle: true when a row of swings about the slow part is complete.
        bool update(double value, const Kind &kind, double dt_s) noexcept;
        [[nodiscard]] bool at_rest() const noexcept;

        double slow = 0.0;    // what the hand does, slowly
        double since_s = 0.0; // since the last swing
        double largest = 0.0; // of this row of swings
        std::int8_t side = 0; // of the last swing
        std::uint8_t count = 0;
    };
    std::array<Channel, kDofCount> speeds_{};
    Channel push_{};
    double scale_ = 1.0;
    double calm_s_ = 0.0;
    double swing_m_s_ = 0.0;
    bool unstable_ = false;
};

} // namespace spidar
