#include "device/safety/monitors/string_monitor.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// Time constant of the usual parity error, which changes over centimeters of motion.
constexpr double kUsual_s = 0.15;
// Difference from the usual error that counts as none.
constexpr double kSame_m = 1e-9;
// Time after which a disagreement is no disturbance.
constexpr double kSuspicion_s = 0.100;
constexpr double kLarge_s = 0.050;
// Duration of an error that grew too slowly to be new: where one string is hardly redundant, a slip
// shows late.
constexpr double kAbove_s = 0.250;
// Share of the parity error that raised a suspicion, below which the suspicion ends.
constexpr double kBack = 0.5;
// Largest change of a count that counts as standing still (encoder flicker).
constexpr std::int32_t kStillCounts = 2;
constexpr double kStill_s = 0.030;
// Change of the parity error that shows a stuck string. One string shows about a third of its
// error: this is 3 mm of motion that the string did not follow, twice what tension stretches.
constexpr double kStuckParity_m = 1.0e-3;
// Smallest error for which a named string is acted on; below it the fade by the parity error
// applies.
constexpr double kNamedError_m = 4.0e-3;
// Parity error per newton of tension (unit: m/N). A braid of EA = 3 kN stretches by 0.14 mm/N at
// 0.4 m, and the eight strings add up by their weights. 0.25 mm/N is the most that simulated play
// shows.
constexpr double kStretch_m_n = 0.3e-3;
// Largest tension at which the observer runs, since it does not model stretch.
constexpr double kNamingMost_n = 3.0;

} // namespace

Status StringMonitor::configure(const ServoSettings &settings) noexcept {
    FaultObserverSettings observed;
    observed.tick_s = 1.0 / settings.rate_hz;
    StringFaultObserver observer;
    // The observer handles crossed grips only. For a rigid grip the parity error shows a fault but
    // not the string.
    const bool names = settings.grip.kind == GripKind::crossed;
    const Status status =
        names ? observer.configure(settings.frame, settings.grip, settings.strings, observed)
              : Status::ok;
    if (!usable(status)) {
        return status;
    }
    *this = StringMonitor();
    observer_ = observer;
    names_ = names;
    fade_m_ = settings.safety.string_error_fade_m;
    fault_m_ = settings.safety.string_error_fault_m;
    return Status::ok;
}

void StringMonitor::reset() noexcept {
    observer_.reset();
    named_ = FaultEvidence();
    started_ = false;
    parity_m_ = 0.0;
    usual_m_ = 0.0;
    suspicious_s_ = 0.0;
    large_s_ = 0.0;
    above_s_ = 0.0;
    string_ = -1;
    faulty_ = false;
}

void StringMonitor::update(const CountArray &counts, const StringArray &lengths_m,
                           const GripState &grip, bool moved, double strongest_n,
                           double dt_s) noexcept {
    const double parity_m = grip.residual_rms_m * std::sqrt(double{kStringCount});
    if (!std::isfinite(parity_m)) {
        return;
    }
    const double stretch_m = kStretch_m_n * strongest_n;
    if (moved && names_ && strongest_n <= kNamingMost_n) {
        KinematicsResult solved;
        solved.residual_rms_m = grip.residual_rms_m;
        solved.status = grip.status;
        const FaultEvidence &found = observer_.update(counts, lengths_m, solved);
        const bool small =
            (found.fault == StringFault::slipped || found.fault == StringFault::slack) &&
            !(std::abs(found.error_m) >= kNamedError_m);
        // A string may stand still legitimately: a named string must also show in the lengths.
        const bool shows = parity_m > kStuckParity_m + stretch_m;
        named_ = small || !shows ? FaultEvidence() : found;
        if (named_.fault != StringFault::none) {
            string_ = named_.string;
        }
    }
    parity_m_ = parity_m;
    if (!started_) {
        started_ = true;
        usual_m_ = parity_m;
        for (std::size_t i = 0; i < still_.size(); ++i) {
            still_[i] = {counts[i], parity_m, 0.0};
        }
        return;
    }
    int stuck = -1;
    for (std::size_t i = 0; i < still_.size(); ++i) {
        Still &still = still_[i];
        const auto off = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts[i]) -
                                                   static_cast<std::uint32_t>(still.count));
        if (off > kStillCounts || off < -kStillCounts) {
            still = {counts[i], parity_m, 0.0};
            continue;
        }
        still.still_s = std::min(kStill_s, still.still_s + dt_s);
        if (still.still_s >= kStill_s && parity_m - still.parity_m > kStuckParity_m + stretch_m) {
            stuck = static_cast<int>(i);
        }
    }
    const double rise_m = parity_m - usual_m_;
    if (suspicious_s_ > 0.0) {
        // The usual error is frozen meanwhile, so that a fault does not become usual.
        suspicious_s_ += dt_s;
        if (!(rise_m > kBack * (fade_m_ + stretch_m)) && stuck < 0) {
            suspicious_s_ = 0.0;
        }
    } else if (rise_m > fade_m_ + stretch_m || stuck >= 0) {
        suspicious_s_ = dt_s;
        string_ = stuck;
    }
    if (!(suspicious_s_ > 0.0)) {
        usual_m_ = rise_m < kSame_m ? parity_m : usual_m_ + rise_m * (dt_s / (dt_s + kUsual_s));
    }
    large_s_ = parity_m > fault_m_ + stretch_m ? large_s_ + dt_s : 0.0;
    above_s_ = parity_m > fade_m_ + stretch_m ? above_s_ + dt_s : 0.0;
    faulty_ =
        faulty_ || above_s_ >= kAbove_s || suspicious_s_ >= kSuspicion_s || large_s_ >= kLarge_s;
}

bool StringMonitor::at_rest() const noexcept {
    const bool calm = started_ && !faulty_ && named_.fault == StringFault::none &&
                      suspicious_s_ == 0.0 && large_s_ == 0.0 && above_s_ == 0.0 &&
                      usual_m_ == parity_m_;
    return calm && std::all_of(still_.begin(), still_.end(),
                               [](const Still &still) { return still.still_s >= kStill_s; });
}

} // namespace spidar
