// Detects forces that shake the grip. A rendering that is too stiff for its latency oscillates at 8
// to 200 Hz; a hand does not, and a tap swings once or twice. The monitor counts swings of the
// velocity in each DOF, and of the force of the contacts, since a firm hand hardly moves. A swing
// counts if it follows the last one soon enough (Kind).
#pragma once

#include "core/base/sound_state.h"
#include "core/base/types.h"

namespace spidar {

class ShakeMonitor {
public:
    void configure() noexcept { *this = ShakeMonitor(); }
    // Takes one cycle. push: wrench of the contacts on the grip. rendering: true while forces act;
    // only then shaking has effect.
    void update(const Twist &twist, const Wrench &push, bool rendering, double dt_s) noexcept;

    // Takes shaking found by another monitor as found here. swing_m_s: its largest swing.
    void found(double swing_m_s) noexcept;

    // Scale of the forces: halved each time the grip shakes, down to 1/4. After kCalm_s without
    // shaking it rises to 1 again, by 1 in a second.
    [[nodiscard]] double scale() const noexcept { return scale_; }
    // True when the grip still shakes after two halvings: forces must end. It stays true until
    // configure() or until kCalm_s have passed without shaking.
    [[nodiscard]] bool unstable() const noexcept { return unstable_; }
    // Largest swing of the last shaking (unit: m/s at the pole ends).
    [[nodiscard]] double swing_m_s() const noexcept { return swing_m_s_; }

    // True when the scale is 1 and no swing was seen lately, so that a grip at rest changes
    // nothing.
    [[nodiscard]] bool at_rest() const noexcept;

    // Time without shaking after which the scale returns (unit: s).
    static constexpr double kCalm_s = 2.0;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(unstable_); }

private:
    struct Kind {
        double least;          // smallest swing that counts
        double longest_half_s; // longest time between two swings of a series
        double slow_s;         // time constant of the slow part
    };
    static const Kind kSpeed; // m/s at the pole ends
    static const Kind kPush;  // N
    struct Channel {
        // Takes one cycle. Returns true when a series of swings about the slow part is complete.
        bool update(double value, const Kind &kind, double dt_s) noexcept;
        [[nodiscard]] bool at_rest() const noexcept;

        double slow = 0.0;    // slow part: what the hand does
        double since_s = 0.0; // time since the last swing
        double largest = 0.0; // largest swing of this series
        std::int8_t side = 0; // sign of the last swing
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
