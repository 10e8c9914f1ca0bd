#include "device/rendering/wrench_request.h"

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/request_fade.h"

namespace spidar {

namespace {

// Returns limit / norm, at most 1, without overflow for components up to the largest double.
double factor_for(const Vec3 &v, double limit) noexcept {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest <= 0.0) {
        return 1.0;
    }
    const Vec3 unit = v / largest;
    const double shape = std::sqrt(unit.x * unit.x + unit.y * unit.y + unit.z * unit.z);
    const double factor = (limit / largest) / shape;
    if (!(factor >= 0.0)) {
        return 0.0; // not finite
    }
    return std::min(1.0, factor);
}

// Share of a limit within which rounding cannot matter.
constexpr double kWellWithin = 1.0 - 1e-12;

bool well_within(const Vec3 &v, double limit) noexcept {
    return v.x * v.x + v.y * v.y + v.z * v.z <= kWellWithin * (limit * limit);
}

} // namespace

double limit_factor(const Wrench &wrench, const SafetySettings &safety) noexcept {
    // The usual case, without a root or a division; NaN and overflow fail it.
    if (well_within(wrench.force_n, safety.max_force_n) &&
        well_within(wrench.moment_nm, safety.max_moment_nm) &&
        std::abs(wrench.grasp_torque_nm) <= kWellWithin * safety.max_grasp_torque_nm) {
        return 1.0;
    }
    const double factor =
        std::min({factor_for(wrench.force_n, safety.max_force_n),
                  factor_for(wrench.moment_nm, safety.max_moment_nm),
                  factor_for(Vec3(wrench.grasp_torque_nm, 0.0, 0.0), safety.max_grasp_torque_nm)});
    return all_finite(factor * wrench) ? factor : 0.0;
}

void WrenchRequest::configure(const SafetySettings &safety) noexcept {
    *this = WrenchRequest();
    safety_ = safety;
}

GainClamp WrenchRequest::accept(const Wrench &wrench, double duration_s) noexcept {
    const double factor = limit_factor(wrench, safety_);
    wrench_ = factor * wrench;
    duration_s_ = duration_s;
    age_s_ = 0.0;
    live_ = true;
    GainClamp clamp;
    clamp.request = GainClamp::Request::wrench;
    capped(1.0, factor, GainClamp::Gain::wrench, 0, false, clamp);
    return clamp;
}

bool WrenchRequest::age(double dt_s) noexcept {
    if (!live_) {
        return false;
    }
    age_s_ += dt_s;
    if (age_s_ < duration_s_ + safety_.wrench_fade_s) {
        return false;
    }
    live_ = false;
    wrench_ = Wrench();
    return true;
}

Wrench WrenchRequest::value() const noexcept {
    return faded_out(age_s_ - duration_s_, safety_.wrench_fade_s) * wrench_; // zero when not live
}

} // namespace spidar
