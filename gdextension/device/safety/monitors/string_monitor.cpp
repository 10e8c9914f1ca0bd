#include "device/safety/monitors/string_monitor.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// The parity error that is usual at a place changes over centimetres of motion: tenths of a second.
constexpr double kUsual_s = 0.15;
// Nearer than this to the usual it is the usual.
constexpr double kSame_m = 1e-9;
// A disagreement that stays this long is no disturbance.
constexpr double kSuspicion_s = 0.100;
constexpr double kLarge_s = 0.050;
// An error that grew too slowly to be noticed as new: where one string is hardly redundant, a slip shows late.
constexpr double kAbove_s = 0.250;
// A suspicion ends when the parity error is back to this part of what raised it.
constexpr double kBack = 0.5;
// A count within this of where it was has not moved (flicker of the encoder).
constexpr std::int32_t kStillCounts = 2;
constexpr double kStill_s = 0.030;
// One string shows about a third of its error: 3 mm of motion that it did not follow, twice what tension stretches.
constexpr double kStuckParity_m = 1.0e-3;
// Errors that the observer names are acted upon from here: below, the fade of the parity error decides.
constexpr double kNamedError_m = 4.0e-3;
// What a newton of tension may add to the parity error: a braid of EA = 3 kN stretches by 0.14 mm/N at 0.4 m, and the
// eight add up by their weights. 0.25 mm/N is the most that simulated play shows in the range of a hand.
constexpr double kStretch_m_n = 0.3e-3;
// The observer knows nothing of stretch: it is asked while there is little.
constexpr double kNamingMost_n = 3.0;

} // namespace

Status StringMonitor::configure(const ServoSettings &settings) noexcept {
    FaultObserverSettings observed;
    observed.tick_s = 1.0 / settings.rate_hz;
    StringFaultObserver observer;
    // The observer knows crossed grips. Of a rigid one the parity error tells that, not what and where.
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
        // A string may rightly stand still for a while: what is named must show in the lengths, too.
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
        // The usual error stands still meanwhile: a fault must not become the usual.
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
