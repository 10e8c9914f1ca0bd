#include "core/diagnosis/string_fault_observer.h"

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"
#include "core/calibration/fit/length_jacobian.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar {

namespace {

// Largest squared misfit that is counted, so that one wild sample is not the whole evidence.
constexpr double kMisfitCap = 60.0;
// Starting standard deviation of a string's error: a slip of 30 mm is large.
constexpr double kStartError_m = 0.03;
// Largest error of a guess. Where a string hardly weighs in the equation, one sample could throw
// its guess anywhere.
constexpr double kLargestError_m = 0.06;
// Squared innovation, in units of its variance, that reopens a filter to errors of kRelearn_m.
constexpr double kSurprise = 25.0;
constexpr double kRelearn_m = 0.01;
// Drift of a string's error, standard deviation in one second. A slipped string stays where it
// slipped to; a slack one moves by a centimeter. The large ratio separates the two.
constexpr double kSlipDrift_m = 2e-4;
constexpr double kSlackDrift_m = 0.008;
// The parity weights belong to a pose that an error of the guess displaces. The linear equation
// misses this value times the square of that error (unit: 1/m). A pose moves by up to four times
// the error of a length, and a weight turns over within about a quarter meter of string.
constexpr double kBend_1_m = 5.0;
// An explanation must fit to this mean squared misfit; others must fit worse by the factor and the
// difference below.
constexpr double kFits = 3.0;
constexpr double kWorseFactor = 1.3;
constexpr double kWorseBy = 0.3;
// Weight of a score's mean from which it is used.
constexpr double kEnoughWeight = 0.3;
constexpr int kDecisionTicks = 16;
// Largest change of a count that counts as standing still (encoder flicker).
constexpr std::int32_t kStillCounts = 2;
// Total travel of the other seven strings after which a still count is stuck.
constexpr double kOthersTravel_m = 0.3;
// Parity error (rms) above which wrong wiring is tried: wrong wiring errs by centimeters once the
// grip moves.
constexpr double kWiringParity_m = 3e-3;
// Turns for which unsolvable lengths are not tried again, since each try costs a cold search.
constexpr int kTurnsToWait = 8;
// Parity residual used for lengths that no pose has.
constexpr double kUnsolved_m = 3.0 * kImpossibleResidual_m;

constexpr auto kPairTable = [] {
    std::array<std::array<std::uint8_t, 2>, 28> table{};
    std::size_t k = 0;
    for (std::uint8_t i = 0; i < kStringCount; ++i) {
        for (std::uint8_t j = i + 1; j < kStringCount; ++j) {
            table[k++] = {i, j};
        }
    }
    return table;
}();

} // namespace

const char *describe(StringFault fault) noexcept {
    switch (fault) {
    case StringFault::none:
        return "none";
    case StringFault::slipped:
        return "slipped";
    case StringFault::slack:
        return "slack";
    case StringFault::stuck:
        return "stuck";
    case StringFault::swapped:
        return "swapped";
    case StringFault::reversed:
        return "reversed";
    }
    return "unknown";
}

Status StringFaultObserver::configure(const FrameGeometry &frame, const GripGeometry &grip,
                                      const StringCalibration &strings,
                                      const FaultObserverSettings &settings) noexcept {
    if (!positive_finite(settings.tick_s) || !positive_finite(settings.parity_noise_m) ||
        !positive_finite(settings.suspicion_m) || !positive_finite(settings.window_s) ||
        !positive_finite(settings.min_error_m) || !(settings.window_s >= 100.0 * settings.tick_s)) {
        return Status::invalid_settings;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (!all_finite(strings.offset_m[i], strings.scale_m_per_count[i]) ||
            strings.scale_m_per_count[i] == 0.0) {
            return Status::invalid_calibration;
        }
    }
    if (grip.kind != GripKind::crossed) {
        return Status::
            invalid_geometry; // a rigid grip has two redundant lengths; this observer handles one
    }
    const Status status = kinematics_.configure(frame, grip);
    if (!usable(status)) {
        return status;
    }
    frame_ = frame;
    grip_ = grip;
    strings_ = strings;
    settings_ = settings;
    configured_ = true;
    reset();
    return Status::ok;
}

void StringFaultObserver::reset() noexcept {
    parity_square_m2_ = 0.0;
    has_last_ = false;
    evidence_ = FaultEvidence{};
    forget_suspects();
}

void StringFaultObserver::forget_suspects() noexcept {
    suspicious_ = false;
    suspects_ = {};
    wirings_ = {};
    for (Suspect &suspect : suspects_) {
        suspect.slipped.variance_m2 = kStartError_m * kStartError_m;
        suspect.slack.variance_m2 = kStartError_m * kStartError_m;
    }
    next_string_ = 0;
    next_wiring_ = 0;
    ticks_to_decision_ = kDecisionTicks;
}

const FaultEvidence &StringFaultObserver::update(const CountArray &counts,
                                                 const StringArray &lengths_m,
                                                 const KinematicsResult &solved) noexcept {
    if (!configured_ || !all_finite(lengths_m)) {
        return evidence_;
    }
    watch_counts(counts, lengths_m);
    // At the least-squares pose the whole residual lies along the null vector.
    const bool fits = usable(solved.status) && std::isfinite(solved.residual_rms_m);
    const double error =
        fits ? solved.residual_rms_m * std::sqrt(double{kStringCount}) : kUnsolved_m;
    const double gain = std::fmin(1.0, 3.0 * settings_.tick_s / settings_.window_s);
    parity_square_m2_ += gain * (error * error - parity_square_m2_);
    evidence_.parity_rms_m = std::sqrt(parity_square_m2_);

    if (!suspicious_ && evidence_.parity_rms_m > settings_.suspicion_m) {
        suspicious_ = true;
    } else if (suspicious_ && evidence_.parity_rms_m < 0.5 * settings_.suspicion_m) {
        forget_suspects();
        const double rms = evidence_.parity_rms_m;
        evidence_ = FaultEvidence{};
        evidence_.parity_rms_m = rms;
    }
    if (suspicious_) {
        try_string(lengths_m);
        if (evidence_.parity_rms_m > kWiringParity_m) {
            try_wiring(lengths_m);
        }
        if (--ticks_to_decision_ <= 0) {
            ticks_to_decision_ = kDecisionTicks;
            decide();
        }
    }
    return evidence_;
}

StringFaultObserver::Parity StringFaultObserver::parity(const StringArray &lengths_m,
                                                        Pose &pose) noexcept {
    if (pose.turns_to_wait > 0) {
        --pose.turns_to_wait;
        return Parity();
    }
    KinematicsResult solved;
    if (pose.known) {
        kinematics_.set_last_pose(pose.pose);
        solved = kinematics_.update(lengths_m);
    } else {
        solved = kinematics_.solve_cold(lengths_m);
    }
    Parity parity;
    pose.known = usable(solved.status);
    pose.turns_to_wait = pose.known ? 0 : kTurnsToWait;
    if (pose.known) {
        pose.pose = solved.pose;
        const LengthJacobian jacobian(frame_, grip_, solved.pose);
        parity.error_m = jacobian.parity_m(lengths_m);
        parity.weights = jacobian.null_vector();
        parity.solved = std::isfinite(parity.error_m);
    }
    return parity;
}

// Solves the pose with the filter's guess removed: the parity residual is then w (error - guess)
// plus the bend.
void StringFaultObserver::advance(Filter &filter, const StringArray &lengths_m, std::size_t string,
                                  double drift_m2, bool positive_only) noexcept {
    const double period = kStringCount * settings_.tick_s;
    const double gain = std::fmin(1.0, period / settings_.window_s);
    StringArray lengths = lengths_m;
    lengths[string] -= filter.error_m;
    const Parity found = parity(lengths, filter.pose);
    if (!found.solved) {
        // No pose has these lengths: the guess or the whole hypothesis is wrong, so the filter
        // restarts.
        filter.misfit.add(kMisfitCap, gain);
        filter.error_m = 0.0;
        filter.variance_m2 = kStartError_m * kStartError_m;
        return;
    }
    const double weight = found.weights[string];
    const double sensor = settings_.parity_noise_m * settings_.parity_noise_m;
    const double square = found.error_m * found.error_m;
    const auto noise = [&] {
        const double bend = kBend_1_m * filter.variance_m2;
        return sensor + bend * bend;
    };
    filter.variance_m2 += drift_m2 * period;
    const double expected = weight * weight * filter.variance_m2 + noise();
    // Minus twice the log likelihood, relative to the sensor's noise alone: a filter that expects
    // anything explains nothing.
    filter.misfit.add(std::fmin(square / expected + std::log(expected / sensor), kMisfitCap), gain);
    if (square > kSurprise * expected) {
        // The guess was wrong and is learned again. The misfit keeps the surprise.
        filter.variance_m2 = std::fmax(filter.variance_m2, kRelearn_m * kRelearn_m);
    }
    const double rest = noise();
    const double spread = weight * weight * filter.variance_m2 + rest;
    filter.error_m += weight * filter.variance_m2 / spread * found.error_m;
    filter.error_m =
        std::clamp(filter.error_m, positive_only ? 0.0 : -kLargestError_m, kLargestError_m);
    filter.variance_m2 *= rest / spread;
}

void StringFaultObserver::try_string(const StringArray &lengths_m) noexcept {
    const std::size_t i = next_string_;
    next_string_ = (next_string_ + 1) % kStringCount;
    advance(suspects_[i].slipped, lengths_m, i, kSlipDrift_m * kSlipDrift_m, false);
    advance(suspects_[i].slack, lengths_m, i, kSlackDrift_m * kSlackDrift_m, true);
}

StringArray StringFaultObserver::rewired(const StringArray &lengths_m,
                                         std::size_t wiring) const noexcept {
    StringArray lengths = lengths_m;
    if (wiring < kPairs) {
        const std::size_t i = kPairTable[wiring][0];
        const std::size_t j = kPairTable[wiring][1];
        const double ratio = strings_.scale_m_per_count[i] / strings_.scale_m_per_count[j];
        lengths[i] = strings_.offset_m[i] + (lengths_m[j] - strings_.offset_m[j]) * ratio;
        lengths[j] = strings_.offset_m[j] + (lengths_m[i] - strings_.offset_m[i]) / ratio;
    } else {
        const std::size_t i = wiring - kPairs;
        lengths[i] = 2.0 * strings_.offset_m[i] - lengths_m[i];
    }
    return lengths;
}

void StringFaultObserver::try_wiring(const StringArray &lengths_m) noexcept {
    const std::size_t k = next_wiring_;
    next_wiring_ = (next_wiring_ + 1) % kWiring;
    const Parity found = parity(rewired(lengths_m, k), wirings_[k].pose);
    const double ratio = found.error_m / settings_.parity_noise_m;
    const double gain =
        std::fmin(1.0, static_cast<double>(kWiring) * settings_.tick_s / settings_.window_s);
    wirings_[k].misfit.add(found.solved ? std::fmin(ratio * ratio, kMisfitCap) : kMisfitCap, gain);
}

void StringFaultObserver::watch_counts(const CountArray &counts,
                                       const StringArray &lengths_m) noexcept {
    if (!has_last_) {
        has_last_ = true;
        anchor_counts_ = counts;
        travel_m_.fill(0.0);
        last_lengths_m_ = lengths_m;
        return;
    }
    StringArray moved{};
    double all = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        moved[i] = std::fabs(lengths_m[i] - last_lengths_m_[i]);
        all += moved[i];
        const auto off = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts[i]) -
                                                   static_cast<std::uint32_t>(anchor_counts_[i]));
        if (off > kStillCounts || off < -kStillCounts) {
            anchor_counts_[i] = counts[i];
            travel_m_[i] = 0.0;
        }
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        travel_m_[i] += all - moved[i];
    }
    last_lengths_m_ = lengths_m;
}

int StringFaultObserver::stuck_string() const noexcept {
    const auto most = std::max_element(travel_m_.begin(), travel_m_.end());
    return *most >= kOthersTravel_m ? static_cast<int>(most - travel_m_.begin()) : -1;
}

void StringFaultObserver::decide() noexcept {
    const int stuck = stuck_string();
    if (stuck >= 0) {
        evidence_.fault = StringFault::stuck;
        evidence_.string = stuck;
        evidence_.other = -1;
        evidence_.error_m = 0.0;
        return;
    }
    FaultEvidence best;
    best.misfit = kMisfitCap;
    best.next_misfit = kMisfitCap;
    bool enough = false;
    const auto offer = [&](const Mean &misfit, FaultEvidence candidate) {
        candidate.misfit = misfit.value();
        const bool same = candidate.string == best.string && candidate.other == best.other;
        if (candidate.misfit < best.misfit) {
            candidate.next_misfit = same ? best.next_misfit : best.misfit;
            best = candidate;
            enough = misfit.weight >= kEnoughWeight;
        } else if (!same) {
            best.next_misfit = std::fmin(best.next_misfit, candidate.misfit);
        }
    };
    for (std::size_t i = 0; i < kStringCount; ++i) {
        FaultEvidence candidate;
        candidate.string = static_cast<int>(i);
        candidate.fault = StringFault::slipped;
        candidate.error_m = suspects_[i].slipped.error_m;
        offer(suspects_[i].slipped.misfit, candidate);
        candidate.fault = StringFault::slack;
        candidate.error_m = suspects_[i].slack.error_m;
        offer(suspects_[i].slack.misfit, candidate);
    }
    for (std::size_t k = 0; k < kWiring; ++k) {
        if (!(wirings_[k].misfit.weight > 0.0)) {
            continue; // not tried yet
        }
        FaultEvidence candidate;
        candidate.fault = k < kPairs ? StringFault::swapped : StringFault::reversed;
        candidate.string = static_cast<int>(k < kPairs ? kPairTable[k][0] : k - kPairs);
        candidate.other = k < kPairs ? kPairTable[k][1] : -1;
        offer(wirings_[k].misfit, candidate);
    }
    const bool small =
        best.fault == StringFault::slipped && !(std::fabs(best.error_m) >= settings_.min_error_m);
    if (enough && !small && best.misfit <= kFits &&
        best.next_misfit >= kWorseFactor * best.misfit &&
        best.next_misfit >= best.misfit + kWorseBy) {
        best.parity_rms_m = evidence_.parity_rms_m;
        evidence_ = best;
    }
}

} // namespace spidar
