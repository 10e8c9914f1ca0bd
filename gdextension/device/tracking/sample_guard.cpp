#include "device/tracking/sample_guard.h"

#include <algorithm>
#include <cmath>

namespace spidar {

void SampleGuard::configure(const StringCalibration &strings, double max_speed_m_s,
                            int max_bad_samples, double nominal_dt_s) noexcept {
    for (std::size_t i = 0; i < metres_per_count_.size(); ++i) {
        metres_per_count_[i] = std::abs(strings.scale_m_per_count[i]);
    }
    max_speed_m_s_ = max_speed_m_s;
    max_bad_samples_ = max_bad_samples;
    nominal_dt_s_ = nominal_dt_s;
    reset();
}

void SampleGuard::reset() noexcept {
    has_reference_ = false;
    elapsed_s_ = 0.0;
    bad_in_row_ = 0;
    bad_string_ = -1;
}

SampleGuard::Verdict SampleGuard::check(const CountArray &counts, double dt_s) noexcept {
    elapsed_s_ += dt_s;
    if (bad_in_row_ >= max_bad_samples_) {
        return Verdict::jumped;
    }
    if (!has_reference_) {
        has_reference_ = true;
        reference_ = counts;
        elapsed_s_ = 0.0;
        return Verdict::good;
    }
    if (counts == reference_) {
        bad_in_row_ = 0;
        elapsed_s_ = 0.0;
        return Verdict::unchanged;
    }
    // The host may fetch two reports closer together than the device sampled them.
    const double limit_m = max_speed_m_s_ * std::max(elapsed_s_, nominal_dt_s_);
    double worst_m = limit_m;
    int worst = -1;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const auto change = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts[i]) -
                                                      static_cast<std::uint32_t>(reference_[i]));
        const double moved_m = std::abs(static_cast<double>(change)) * metres_per_count_[i];
        if (!(moved_m <= worst_m)) {
            worst_m = moved_m;
            worst = static_cast<int>(i);
        }
    }
    if (worst >= 0) {
        bad_string_ = worst;
        ++bad_in_row_;
        return bad_in_row_ >= max_bad_samples_ ? Verdict::jumped : Verdict::bad;
    }
    bad_in_row_ = 0;
    reference_ = counts;
    elapsed_s_ = 0.0;
    return Verdict::good;
}

} // namespace spidar
