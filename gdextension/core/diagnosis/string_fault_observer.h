// Which string is slack, slipped, stuck, swapped or wound the other way? Eight lengths on seven
// degrees of freedom leave one equation a pose; over a motion its weights change, so that one wrong
// string explains all of them and the others do not.
//
// Servo-safe: update() allocates nothing and does bounded work. While the lengths fit, that is one
// comparison. Once they do not, suspicions are tried in turn, two or three a tick, each by solving
// the pose from the lengths it would correct:
//   eight strings: one length off by an error that stays (slipped) or is positive and varies
//   (slack), estimated by a scalar Kalman filter each; 28 pairs swapped; 8 strings wound the other
//   way.
// A stuck string needs no solving: its count stands still while the others move and the lengths do
// not fit.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"
#include "core/base/types.h"
#include "core/calibration/string_calibration.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar {

enum class StringFault : std::uint8_t { none, slipped, slack, stuck, swapped, reversed };

// One word; never null.
[[nodiscard]] const char *describe(StringFault fault) noexcept;

struct FaultObserverSettings {
    double tick_s = 1e-3;
    // Parity residual of a healthy device (standard deviation): noise, and what calibration left.
    double parity_noise_m = 2e-4;
    // Parity residual (rms over window_s / 3) above which the suspicions are tried.
    double suspicion_m = 6e-4;
    double window_s = 1.5; // memory of the scores
    // Length error of a string below which nothing is reported.
    double min_error_m = 2.5e-3;
};

struct FaultEvidence {
    StringFault fault = StringFault::none;
    int string = -1;      // 0-7
    int other = -1;       // swapped: the second string, string < other
    double error_m = 0.0; // slipped, slack: how much too long the string reads
    // Of the best explanation and of the best one about another string, mean over window_s: minus twice the logarithm of
    // the likelihood, in units of parity_noise_m, 0 where all fits exactly. Far apart = sure.
    double misfit = 0.0;
    double next_misfit = 0.0;
    double parity_rms_m = 0.0; // of the lengths as they are
};

// core/base/sound_state.h
[[nodiscard]] constexpr bool is_sound(const FaultEvidence &evidence) noexcept {
    return is_one_of(evidence.fault, StringFault::reversed) && is_string_or_none(evidence.string) &&
           is_string_or_none(evidence.other);
}

class StringFaultObserver {
public:
    // invalid_geometry, invalid_calibration, invalid_settings: the old configuration stands.
    Status configure(const FrameGeometry &frame, const GripGeometry &grip,
                     const StringCalibration &strings,
                     const FaultObserverSettings &settings) noexcept;
    void reset() noexcept;

    // One servo tick: the counts, the lengths made of them, and what the servo's kinematics found
    // for these. Lengths that are not finite are skipped.
    const FaultEvidence &update(const CountArray &counts, const StringArray &lengths_m,
                                const KinematicsResult &solved) noexcept;
    // core/base/sound_state.h
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
    static constexpr std::size_t kWiring =
        kPairs + kStringCount; // swapped pairs, then reversed strings

    // Mean of the last values, each weighing less than the next.
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
        StringArray weights{}; // the null vector
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
    CountArray anchor_counts_{}; // where each string was when its count last moved
    StringArray travel_m_{};     // of the other strings since then
    StringArray last_lengths_m_{};
    bool has_last_ = false;
    FaultEvidence evidence_;
};

} // namespace spidar
