#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/contract/dof_lanes.h"
#include "device/rendering/coupling_request.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

GripMotion at_rest() {
    GripMotion motion;
    motion.grip.pose = rest_pose(GripGeometry());
    motion.grip.frame = frame_of(motion.grip.pose, Mat3(1.0));
    return motion;
}

struct Rig {
    CouplingRequest request;
    Coupling coupling;
    GripMotion motion = at_rest();

    Rig() {
        request.configure(ServoSettings());
        coupling.dof_mask = kAllDof;
    }
    // Renewed at 60 Hz, as games do.
    Wrench play(int ticks) {
        Wrench wrench;
        for (int i = 0; i < ticks; ++i) {
            request.age(kTick_s);
            if (i % 16 == 0) {
                request.accept(coupling, 0.0);
            }
            wrench = request.render(motion);
        }
        return wrench;
    }
};

} // namespace

TEST_CASE("coupling: a spring in each of seven DOF, only where the mask says") {
    for (int dof = 0; dof < kDofCount; ++dof) {
        for (const bool masked : {false, true}) {
            Rig rig;
            const auto i = static_cast<std::size_t>(dof);
            const double away = dof < 3 ? 0.004 : 0.1;
            if (dof < 3) {
                rig.coupling.position_m[dof] = away;
            } else if (dof < 6) {
                Vec3 axis(0.0);
                axis[dof - 3] = 1.0;
                rig.coupling.rotation = glm::mat3_cast(glm::angleAxis(away, axis));
            } else {
                rig.coupling.grasp_angle_rad = away;
            }
            rig.coupling.dof_mask =
                masked ? static_cast<std::uint8_t>(kAllDof & ~(1U << dof)) : kAllDof;
            const Wrench w = rig.play(100);
            const DofLanes given = lanes(w);
            CAPTURE(dof);
            for (int k = 0; k < kDofCount; ++k) {
                const bool acts = k == dof && !masked;
                CHECK(given[static_cast<std::size_t>(k)] ==
                      doctest::Approx(acts ? rig.coupling.stiffness[i] * away : 0.0));
            }
        }
    }
}

TEST_CASE("coupling: damping against the proxy's own speed; the proxy moves on, then stands") {
    Rig rig;
    rig.coupling.twist.linear_m_s.x = 0.1;
    rig.motion.velocity.linear_m_s.x = 0.1;
    rig.play(96); // the last update is 16 ms old in the next cycle
    rig.request.age(kTick_s);
    rig.request.accept(rig.coupling, 0.0);
    double stands_n = 0.0;
    for (int ms = 1; ms <= 95; ++ms) {
        rig.request.age(kTick_s);
        const double force_n = rig.request.render(rig.motion).force_n.x;
        CAPTURE(ms);
        if (ms >= 17 && ms < 30) { // the jump of the update itself is over
            CHECK(force_n == doctest::Approx(350.0 * 0.1e-3 * ms));
        } else if (ms == 60) { // past two and a half frames of 16 ms
            stands_n = force_n;
            CHECK(stands_n > 350.0 * 0.1e-3 * 30 - 2.0 * 0.1);
            CHECK(stands_n < 350.0 * 0.1e-3 * 41 - 2.0 * 0.1);
        } else if (ms > 60) {
            CHECK(force_n == doctest::Approx(stands_n));
        }
    }
}

TEST_CASE("coupling: a proxy that says when it was computed is moved on from then") {
    Rig rig;
    rig.coupling.twist.linear_m_s.x = 0.1;
    rig.coupling.state_time_s = 5.0;
    rig.motion.velocity.linear_m_s.x = 0.1;
    rig.play(96);
    rig.request.accept(rig.coupling, 5.004); // 4 ms old
    for (int ms = 1; ms < 26; ++ms) {
        rig.request.age(kTick_s);
        if (ms >= 17) {
            CAPTURE(ms);
            CHECK(rig.request.render(rig.motion).force_n.x ==
                  doctest::Approx(350.0 * 0.1e-3 * (ms + 4)));
        }
    }
}

TEST_CASE("coupling: a proxy that jumps is followed over one game period") {
    Rig rig;
    rig.play(96);
    rig.coupling.position_m.x = 0.004;
    rig.request.accept(rig.coupling, 0.0);
    double last_n = 0.0;
    for (int ms = 1; ms <= 20; ++ms) {
        rig.request.age(kTick_s);
        const double force_n = rig.request.render(rig.motion).force_n.x;
        CHECK(force_n - last_n <= 350.0 * 0.004 / 16.0 + 1e-9);
        last_n = force_n;
    }
    CHECK(last_n == doctest::Approx(350.0 * 0.004));
}

TEST_CASE("coupling: force caps hold; gains beyond the caps are named") {
    Rig rig;
    rig.coupling.position_m = Vec3(0.3, -0.4, 0.0);
    rig.coupling.grasp_angle_rad = -3.0;
    const Wrench w = rig.play(100);
    CHECK(glm::length(w.force_n) == doctest::Approx(rig.coupling.max_force_n));
    CHECK(w.force_n.x / w.force_n.y == doctest::Approx(-0.75)); // direction kept
    CHECK(w.grasp_torque_nm == doctest::Approx(-rig.coupling.max_grasp_torque_nm));
    rig.coupling.stiffness[4] = 1000.0;
    const GainClamp clamp = rig.request.accept(rig.coupling, 0.0);
    CHECK(clamp.gain == GainClamp::Gain::turn_stiffness);
    CHECK(clamp.request == GainClamp::Request::coupling);
    CHECK(clamp.index == 4);
    CHECK(clamp.asked == 1000.0);
}

TEST_CASE("coupling: begins gradually, fades when forgotten, goes when withdrawn") {
    Rig rig;
    rig.coupling.position_m.x = 0.004;
    const double full_n = 350.0 * 0.004;
    rig.request.accept(rig.coupling, 0.0);
    rig.request.age(kTick_s);
    CHECK(rig.request.render(rig.motion).force_n.x <= full_n / 50.0 + 1e-9);
    rig.play(97); // the last update is now of this cycle
    bool ended = false;
    for (int ms = 1; ms <= 310; ++ms) {
        const bool ends = rig.request.age(kTick_s);
        CHECK_FALSE((ends && ended));
        ended = ended || ends;
        const double left = ms <= 100 ? 1.0 : ms >= 300 ? 0.0 : (300 - ms) / 200.0;
        CHECK(rig.request.render(rig.motion).force_n.x == doctest::Approx(left * full_n));
    }
    CHECK(ended);
    rig.play(97);
    rig.coupling.dof_mask = 0;
    rig.request.accept(rig.coupling, 0.0);
    for (int ms = 1; ms <= 20; ++ms) {
        CHECK_FALSE(rig.request.age(kTick_s)); // withdrawn: not an expiry
    }
    CHECK(rig.request.at_rest());
    CHECK(rig.request.render(rig.motion).force_n.x == 0.0);
}

TEST_CASE("coupling: what is not usable is refused") {
    Coupling good;
    good.dof_mask = kAllDof;
    CHECK(validate_coupling(good) == Status::ok);
    Coupling bad = good;
    bad.stiffness[3] = -1.0;
    CHECK(validate_coupling(bad) == Status::invalid_request);
    bad = good;
    bad.rotation[1] *= 1.1;
    CHECK(validate_coupling(bad) == Status::invalid_request);
    bad = good;
    bad.rotation[2] *= -1.0; // a mirror
    CHECK(validate_coupling(bad) == Status::invalid_request);
    bad = good;
    bad.twist.angular_rad_s.y = std::nan("");
    CHECK(validate_coupling(bad) == Status::not_finite);
    bad = good;
    bad.dof_mask = 0x80;
    CHECK(validate_coupling(bad) == Status::invalid_request);
}
