#include "core/kinematics/grasp_detector.h"

#include <cmath>

#include "core/base/describe_value.h"

namespace spidar {

namespace {

constexpr double kHalfPi = 1.5707963267948966;
// Longest dwell: a longer one is a unit error (milliseconds typed as seconds).
constexpr double kMaxDwell_s = 5.0;

// Returns the phase of this angle; the present phase selects the side of each hysteresis band.
GraspPhase phase_asked(const GraspSettings &settings, GraspPhase now, double angle_rad) noexcept {
    const double over =
        now == GraspPhase::over_closed ? settings.over_closed_leave_rad : settings.over_closed_rad;
    const double grasp = now == GraspPhase::open ? settings.enter_rad : settings.leave_rad;
    // over_closed is left below over_closed_leave_rad and entered above over_closed_rad.
    if (now == GraspPhase::over_closed ? angle_rad >= over : angle_rad > over) {
        return GraspPhase::over_closed;
    }
    return angle_rad >= grasp ? GraspPhase::grasped : GraspPhase::open;
}

std::string angle_message(const char *field, double value_rad, const char *remedy) {
    return range_sentence(field, value_rad,
                          "rad (" + with_unit(value_rad / kDegree_rad, "degrees") + ")", remedy);
}

} // namespace

GraspPhase GraspDetector::update(double grasp_angle_rad, double dt_s) noexcept {
    if (!std::isfinite(grasp_angle_rad)) {
        return phase_;
    }
    const GraspPhase asked = phase_asked(settings_, phase_, grasp_angle_rad);
    if (asked == phase_) {
        candidate_ = phase_; // the next requested phase starts its dwell
        return phase_;
    }
    if (asked != candidate_) {
        candidate_ = asked;
        candidate_age_s_ = 0.0; // the time before this sample belongs to the earlier phase
    } else if (dt_s > 0.0 && std::isfinite(dt_s)) {
        candidate_age_s_ += dt_s;
    }
    if (candidate_age_s_ >= settings_.dwell_s) {
        phase_ = candidate_;
    }
    return phase_;
}

std::string validate(const GraspSettings &settings) {
    const struct {
        const char *name;
        double value_rad;
    } angles[] = {{"leave_rad", settings.leave_rad},
                  {"enter_rad", settings.enter_rad},
                  {"over_closed_leave_rad", settings.over_closed_leave_rad},
                  {"over_closed_rad", settings.over_closed_rad}};
    for (const auto &angle : angles) {
        if (!(std::fabs(angle.value_rad) <= kHalfPi)) {
            return angle_message(angle.name, angle.value_rad,
                                 "give an angle between -90 and 90 degrees, in radians.");
        }
    }
    if (!(settings.leave_rad <= settings.enter_rad)) {
        return angle_message(
            "leave_rad", settings.leave_rad,
            "set it to enter_rad or less: a grasp ends at a smaller angle than it begins.");
    }
    if (!(settings.over_closed_leave_rad <= settings.over_closed_rad)) {
        return angle_message("over_closed_leave_rad", settings.over_closed_leave_rad,
                             "set it to over_closed_rad or less.");
    }
    if (!(settings.enter_rad < settings.over_closed_leave_rad)) {
        return angle_message("enter_rad", settings.enter_rad,
                             "set it below over_closed_leave_rad, or nothing is ever grasped.");
    }
    if (!(settings.dwell_s >= 0.0) || !(settings.dwell_s <= kMaxDwell_s)) {
        return range_sentence("dwell_s", settings.dwell_s, "s",
                              "give 0 to " + with_unit(kMaxDwell_s, "s") + " (default 0.03 s).");
    }
    return {};
}

} // namespace spidar
