// Five seconds of T1-like motion of a device with one faulty string, and what the observer says at
// the end.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/diagnosis/string_fault_observer.h"
#include "core/kinematics/forward_kinematics.h"
#include "support/motion_samples.h"

namespace spidar::test {

inline constexpr double kTick_s = 1e-3;
inline constexpr double kMotionNoise_m = 1e-4;

// T1 with its own phases, and each frequency within 15 %.
struct MotionLikeT1 {
    std::array<double, kDofCount> rate{};
    std::array<double, kDofCount> phase{};

    explicit MotionLikeT1(Draw &draw) {
        constexpr std::array<double, kDofCount> kRates{3.1, 2.3, 2.9, 4.1, 3.7, 3.3, 2.1};
        for (std::size_t k = 0; k < kDofCount; ++k) {
            rate[k] = kRates[k] * draw.between(0.85, 1.15);
            phase[k] = draw.between(0.0, 6.283185307179586);
        }
    }
    [[nodiscard]] GripPose at(const GripGeometry &grip, double t) const {
        const auto wave = [&](std::size_t k) { return std::sin(rate[k] * t + phase[k]); };
        return pose_at(grip, Vec3(0.15 * wave(0), 0.15 * wave(1), 0.12 * wave(2)),
                       Vec3(0.6 * wave(3), 0.6 * wave(4), 0.5 * wave(5)), 0.5 * wave(6));
    }
};

struct FaultCase {
    StringFault fault = StringFault::none;
    int string = 0;
    int other = -1;
    double size_m = 0.0;  // slipped: signed; slack: the largest
    double onset_s = 0.0; // swapped and reversed strings are so from the start
    double rate_hz = 0.0; // slack: comes and goes
};

inline FaultCase random_fault(Draw &draw, StringFault fault) {
    FaultCase c;
    c.fault = fault;
    c.string = draw.below(kStringCount);
    if (fault == StringFault::swapped) {
        c.other = (c.string + 1 + draw.below(kStringCount - 1)) % kStringCount;
        if (c.other < c.string) {
            std::swap(c.other, c.string);
        }
    }
    c.size_m = draw.between(0.005, 0.025);
    if (fault == StringFault::slipped && draw.between(0.0, 1.0) < 0.5) {
        c.size_m = -c.size_m;
    }
    c.onset_s = draw.between(0.0, 1.0);
    c.rate_hz = draw.between(0.2, 0.8);
    return c;
}

class FaultyDevice {
public:
    // calibration_error_m: standard deviation of the offsets that the observer's calibration has wrong.
    FaultyDevice(const FaultCase &fault, Draw &draw, double calibration_error_m = 0.0)
        : fault_(fault), draw_(draw), motion_(draw), device_(paper_device()),
          believed_(device_.strings) {
        if (calibration_error_m > 0.0) {
            for (double &offset_m : believed_.offset_m) {
                offset_m += calibration_error_m * draw.normal();
            }
        }
        kinematics_.configure(device_.frame, device_.grip);
        observer_.configure(device_.frame, device_.grip, believed_, FaultObserverSettings{});
    }
    const FaultEvidence &step(double t) {
        CountArray counts = counts_at_time(t);
        const StringArray lengths = lengths_from_counts(believed_, counts);
        return observer_.update(counts, lengths, kinematics_.update(lengths));
    }

    // Forgets what it has seen: the pose and the observer's suspicions.
    void reset() noexcept {
        kinematics_.reset();
        observer_.reset();
    }
    // Two observers of one device see the same: this one is asked in place of its own.
    const FaultEvidence &step_with(StringFaultObserver &other, const CountArray &counts) {
        const StringArray lengths = lengths_from_counts(believed_, counts);
        return other.update(counts, lengths, kinematics_.update(lengths));
    }
    [[nodiscard]] StringFaultObserver observer() const { return observer_; }
    CountArray counts_at_time(double t) {
        const auto s = static_cast<std::size_t>(fault_.string);
        const bool on = t >= fault_.onset_s;
        StringArray lengths =
            string_lengths(device_.frame, device_.grip, motion_.at(device_.grip, t));
        if (on && fault_.fault == StringFault::slipped) {
            lengths[s] += fault_.size_m;
        } else if (on && fault_.fault == StringFault::slack) {
            const double turn = 6.283185307179586 * fault_.rate_hz * (t - fault_.onset_s);
            lengths[s] += 0.5 * fault_.size_m * (1.0 - std::cos(turn));
        }
        CountArray counts = counts_of(device_, lengths, kMotionNoise_m, draw_);
        if (fault_.fault == StringFault::swapped) {
            std::swap(counts[s], counts[static_cast<std::size_t>(fault_.other)]);
        } else if (fault_.fault == StringFault::reversed) {
            counts[s] = -counts[s];
        } else if (fault_.fault == StringFault::stuck) {
            if (on && stuck_) {
                counts[s] = stuck_count_;
            }
            stuck_ = on;
            stuck_count_ = counts[s];
        }
        return counts;
    }

private:
    FaultCase fault_;
    Draw &draw_;
    MotionLikeT1 motion_;
    DeviceModel device_;
    StringCalibration believed_;
    ForwardKinematics kinematics_;
    StringFaultObserver observer_;
    bool stuck_ = false;
    std::int32_t stuck_count_ = 0;
};

inline FaultEvidence evidence_after(const FaultCase &fault, Draw &draw, double duration_s) {
    FaultyDevice device(fault, draw);
    FaultEvidence evidence;
    const int ticks = static_cast<int>(std::lround(duration_s / kTick_s));
    for (int k = 0; k < ticks; ++k) {
        evidence = device.step(k * kTick_s);
    }
    return evidence;
}

// The right string, and the right pair when swapped.
inline bool right_string(const FaultCase &fault, const FaultEvidence &evidence) {
    return evidence.fault != StringFault::none && evidence.string == fault.string &&
           evidence.other == fault.other;
}

} // namespace spidar::test
