#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "device/contract/dof_lanes.h"
#include "device/rendering/wrench_request.h"

using namespace spidar;

TEST_CASE("wrench request: full to its duration, half at half the fade, gone after it") {
    WrenchRequest request;
    request.configure(SafetySettings());
    CHECK_FALSE(request.accept({Vec3(0.0, 2.0, 0.0), Vec3(0.0), 0.0}, 0.050));
    bool ended = false;
    for (int ms = 1; ms <= 120; ++ms) {
        const bool ends = request.age(0.001);
        CHECK_FALSE((ends && ended));
        ended = ended || ends;
        const double force_n = request.value().force_n.y;
        const double known_n = ms <= 50 ? 2.0 : ms >= 100 ? 0.0 : 2.0 * (100 - ms) / 50.0;
        CAPTURE(ms);
        CHECK(std::abs(force_n - known_n) < 1e-9);
    }
    CHECK(ended);
}

TEST_CASE("wrench request: too large is scaled by one factor, the 7-D direction is kept") {
    const SafetySettings safety;
    WrenchRequest request;
    request.configure(safety);
    const Wrench asked{Vec3(60.0, 80.0, 0.0), Vec3(0.0, 0.0, 0.2), 0.1};
    CHECK(request.accept(asked, 0.05));
    const Wrench given = request.value();
    CHECK(glm::length(given.force_n) == doctest::Approx(safety.max_force_n));
    const double factor = given.force_n.x / 60.0;
    CHECK(given.force_n.y == doctest::Approx(80.0 * factor));
    CHECK(given.moment_nm.z == doctest::Approx(0.2 * factor));
    CHECK(given.grasp_torque_nm == doctest::Approx(0.1 * factor));
}

TEST_CASE("limits hold for the largest and smallest doubles") {
    const SafetySettings safety;
    for (const double size : {1e308, -1e308, 1e200, 5e-324, 1e-310}) {
        const Wrench wrench{Vec3(size), Vec3(size), size};
        const Wrench limited = limit_factor(wrench, safety) * wrench;
        CAPTURE(size);
        CHECK(glm::length(limited.force_n) <= safety.max_force_n * (1.0 + 1e-12));
        CHECK(glm::length(limited.moment_nm) <= safety.max_moment_nm * (1.0 + 1e-12));
        CHECK(std::abs(limited.grasp_torque_nm) <= safety.max_grasp_torque_nm * (1.0 + 1e-12));
        CHECK(std::isfinite(limited.force_n.x));
    }
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    CHECK(limit_factor({Vec3(kNan, 0.0, 0.0), Vec3(0.0), 0.0}, safety) == 0.0);
    CHECK(limit_factor({Vec3(0.0), Vec3(0.0, kInfinity, 0.0), 0.0}, safety) == 0.0);
    CHECK(limit_factor({Vec3(0.0), Vec3(0.0), kNan}, safety) == 0.0);
    CHECK(limit_factor(Wrench(), safety) == 1.0);
}
