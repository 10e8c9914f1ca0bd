#include <doctest/doctest.h>

#include <limits>

#include "core/kinematics/grasp_detector.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

// Holds an angle for a number of ticks; the phase after the last.
GraspPhase hold(GraspDetector &detector, double degrees, int ticks) {
    GraspPhase phase = detector.phase();
    for (int i = 0; i < ticks; ++i) {
        phase = detector.update(degrees * kDegree_rad, kTick_s);
    }
    return phase;
}

} // namespace

TEST_CASE("grasp: a new phase counts only after its dwell") {
    GraspDetector detector;
    CHECK(hold(detector, 25.0, 29) == GraspPhase::open);
    CHECK(hold(detector, 10.0, 1) == GraspPhase::open); // one sample back starts the dwell anew
    CHECK(hold(detector, 25.0, 29) == GraspPhase::open);
    CHECK(hold(detector, 25.0, 3) == GraspPhase::grasped);
}

TEST_CASE("grasp: hysteresis between entering and leaving") {
    GraspDetector detector;
    CHECK(hold(detector, 19.0, 100) == GraspPhase::open); // below enter
    CHECK(hold(detector, 21.0, 100) == GraspPhase::grasped);
    CHECK(hold(detector, 16.0, 100) == GraspPhase::grasped); // above leave
    CHECK(hold(detector, 54.0, 100) == GraspPhase::grasped);
    CHECK(hold(detector, 56.0, 100) == GraspPhase::over_closed);
    CHECK(hold(detector, 51.0, 100) == GraspPhase::over_closed);
    CHECK(hold(detector, 49.0, 100) == GraspPhase::grasped);
    CHECK(hold(detector, 14.0, 100) == GraspPhase::open);
    CHECK(hold(detector, 60.0, 100) == GraspPhase::over_closed);
    CHECK(hold(detector, 10.0, 100) == GraspPhase::open);
}

TEST_CASE("grasp: noise around a threshold does not chatter") {
    GraspDetector detector;
    int changes = 0;
    GraspPhase last = detector.phase();
    for (int i = 0; i < 2000; ++i) {
        const double noise = i % 2 == 0 ? 4.0 : -4.0;
        const GraspPhase phase = detector.update((20.0 + noise) * kDegree_rad, kTick_s);
        changes += phase != last ? 1 : 0;
        last = phase;
    }
    CHECK(changes <= 1);
}

TEST_CASE("grasp: values that are not finite change nothing") {
    GraspDetector detector;
    hold(detector, 30.0, 100);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()}) {
        for (int i = 0; i < 100; ++i) {
            CHECK(detector.update(bad, kTick_s) == GraspPhase::grasped);
        }
    }
    // A time step that is not finite does not let the dwell pass.
    detector.update(0.0, kTick_s);
    CHECK(detector.update(0.0, std::numeric_limits<double>::infinity()) == GraspPhase::grasped);
    CHECK(detector.update(0.0, std::numeric_limits<double>::quiet_NaN()) == GraspPhase::grasped);
    CHECK(detector.update(0.0, -1.0) == GraspPhase::grasped);
    CHECK(detector.update(0.0, 0.031) == GraspPhase::open);
}

TEST_CASE("grasp: validate names field, value, unit and remedy") {
    CHECK(validate(GraspSettings{}).empty());
    GraspSettings bad;
    bad.leave_rad = 30.0 * kDegree_rad;
    CHECK(validate(bad).find("leave_rad is 0.523598776 rad (30 degrees); set it to enter_rad") ==
          0);
    bad = GraspSettings{};
    bad.dwell_s = 30.0;
    CHECK(validate(bad).find("dwell_s is 30 s; give") == 0);
    bad = GraspSettings{};
    bad.enter_rad = std::numeric_limits<double>::quiet_NaN();
    CHECK(validate(bad).find("enter_rad is nan rad") == 0);
}

TEST_CASE("grasp: settings of one's own count in place of the defaults") {
    GraspDetector detector;
    GraspSettings settings;
    settings.enter_rad = 10.0 * kDegree_rad;
    settings.leave_rad = 5.0 * kDegree_rad;
    settings.dwell_s = 0.010;
    detector.configure(settings);
    CHECK(hold(detector, 12.0, 8) == GraspPhase::open);
    CHECK(hold(detector, 12.0, 4) == GraspPhase::grasped);
    CHECK(hold(detector, 7.0, 100) == GraspPhase::grasped);
    CHECK(hold(detector, 4.0, 20) == GraspPhase::open);
}
