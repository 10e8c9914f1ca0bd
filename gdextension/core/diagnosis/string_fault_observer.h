// Finds which string is slack, slipped, stuck, swapped or wound the other way. Eight lengths on
// seven DOF leave one equation per pose. The weights of the strings in it change over a motion, so
// that only the string that is wrong explains the errors of all poses.
//
// Servo-safe: update() allocates nothing and does bounded work. While the lengths fit a pose,
// update() solves no pose. Once they do not fit, it tries two or three hypotheses per tick, and
// solves for each the pose from lengths that the hypothesis corrects:
// - one of eight strings off by a constant error (slipped) or by a positive, varying error (slack),
// each estimated by a scalar Kalman filter;
// - one of 28 pairs swapped;
// - one of eight strings wound the other way.
// A stuck string needs no pose: its count stands still while the others move and the lengths do not
// fit.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"
#include "core/base/types.h"
#include "core/calibration/string_calibration.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar {

enum class StringFault : std::uint8_t { none, slipped, slack, stuck, swapped, reversed };

// Returns one word; never null.
[[nodiscard]] const char *describe(StringFault fault) noexcept;

struct FaultObserverSettings {
    // Time between two calls of update().
    double tick_s = 1e-3;
    // Standard deviation of the parity error of a healthy device: noise and calibration error.
    double parity_noise_m = 2e-4;
    // Parity error (rms over window_s / 3) above which the hypotheses are tried.
    double suspicion_m = 6e-4;
    double window_s = 1.5; // averaging time of the scores; at least 100 ticks
    // Smallest length error of a slipped string that is reported.
    double min_error_m = 2.5e-3;
};

struct FaultEvidence {
    StringFault fault = StringFault::none;
    int string = -1;      // 0-7, or -1 for none
    int other = -1;       // swapped: the second string, string < other; else -1
    double error_m = 0.0; // slipped or slack: measured minus true length of the string
    // Score of this explanation, mean over window_s: -2 log likelihood in units of parity_noise_m,
    // 0 for a perfect fit.
    double misfit = 0.0;
    // Score of the best explanation with another string. The more it exceeds `misfit`, the surer is
    // this explanation.
    double next_misfit = 0.0;
    double parity_rms_m = 0.0; // of the uncorrected lengths
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] constexpr bool is_sound(const FaultEvidence &evidence) noexcept {
    return is_one_of(evidence.fault, StringFault::reversed) && is_string_or_none(evidence.string) &&
           is_string_or_none(evidence.other);
}

class StringFaultObserver {
public:
    // On a negative status the old configuration stays. A rigid grip gets invalid_geometry: it has
    // two redundant lengths.
    Status configure(const FrameGeometry &frame, const GripGeometry &grip,
                     const StringCalibration &strings,
                     const FaultObserverSettings &settings) noexcept;
    void reset() noexcept;

    // Takes one servo tick: the counts, the lengths computed from them, and the kinematics' result
    // for these lengths. Ignores lengths that are not finite.
    const FaultEvidence &update(const CountArray &counts, const StringArray &lengths_m,
                                const KinematicsResult &solved) noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(configured_, suspicious_, has_last_) && spidar::is_sound(grip_) &&
               kinematics_.is_sound() && next_string_ < kStringCount && next_wiring_ < kWiring &&
               is_tally(ticks_to_decision_) && spidar::is_sound(evidence_) &&
               std::all_of(suspects_.begin(), suspects_.end(),
                           [](const auto &one) {
                               return is_sound(one.slipped.pose) && is_sound(one.slack.pose);
                           }) &&
               std::all_of(wirings_.begin(), wirings_.end(),
                           [](const auto &one) { return is_sound(one.pose); });
    }

private:
    static constexpr std::size_t kPairs = 28;
    // Wiring hypotheses: swapped pairs, then reversed strings.
    static constexpr std::size_t kWiring = kPairs + kStringCount;

    // Exponentially weighted mean, unbiased from the first value on.
    struct Mean {
        double sum = 0.0;
        double weight = 0.0;
        void add(double value, double gain) noexcept {
            sum += gain * (value - sum);
            weight += gain * (1.0 - weight);
        }
        [[nodiscard]] double value() const noexcept { return weight > 0.0 ? sum / weight : 0.0; }
    };
    struct Pose {
        GripPose pose;
        bool known = false;
        // Calls of parity() to skip after lengths that no pose had.
        int turns_to_wait = 0;
    };
    [[nodiscard]] static bool is_sound(const Pose &pose) noexcept {
        return are_flags(pose.known) && is_tally(pose.turns_to_wait);
    }
    struct Filter { // length error of one string (unit: m)
        Pose pose;
        double error_m = 0.0;
        double variance_m2 = 0.0;
        Mean misfit;
    };
    struct Suspect {
        Filter slipped;
        Filter slack;
    };
    struct Wiring {
        Pose pose;
        Mean misfit;
    };
    struct Parity {
        double error_m = 0.0;
        StringArray weights{}; // the null vector at the solved pose
        bool solved = false;
    };

    void forget_suspects() noexcept;
    Parity parity(const StringArray &lengths_m, Pose &pose) noexcept;
    void try_string(const StringArray &lengths_m) noexcept;
    void try_wiring(const StringArray &lengths_m) noexcept;
    void advance(Filter &filter, const StringArray &lengths_m, std::size_t string, double drift_m2,
                 bool positive_only) noexcept;
    void watch_counts(const CountArray &counts, const StringArray &lengths_m) noexcept;
    void decide() noexcept;
    [[nodiscard]] int stuck_string() const noexcept;
    [[nodiscard]] StringArray rewired(const StringArray &lengths_m,
                                      std::size_t wiring) const noexcept;

    FrameGeometry frame_{};
    GripGeometry grip_{};
    StringCalibration strings_{};
    FaultObserverSettings settings_{};
    ForwardKinematics kinematics_;
    bool configured_ = false;

    double parity_square_m2_ = 0.0;
    bool suspicious_ = false;
    std::array<Suspect, kStringCount> suspects_{};
    std::array<Wiring, kWiring> wirings_{};
    std::size_t next_string_ = 0;
    std::size_t next_wiring_ = 0;
    int ticks_to_decision_ = 0;
    CountArray anchor_counts_{}; // count of each string when the string last moved
    StringArray travel_m_{};     // sum of the other strings' motion since then
    StringArray last_lengths_m_{};
    bool has_last_ = false;
    FaultEvidence evidence_;
};

} // namespace spidar
