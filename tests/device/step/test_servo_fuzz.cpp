// Random commands, from sane to absurd, must never get past the gate; and a step must not allocate.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <new>
#include <random>

#include <glm/geometric.hpp>

#include "support/allocation_trap.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::allocations_of_this_thread;
using spidar::test::Bench;

namespace {

struct Fuzz {
    std::mt19937_64 random;
    explicit Fuzz(std::uint64_t seed) : random(seed) {}

    bool one_in(unsigned n) { return random() % n == 0; }
    double sane(double size) { return std::uniform_real_distribution<double>(-size, size)(random); }
    double any(double size) {
        const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(),
                              1e308,
                              -1e308,
                              5e-324,
                              -1e-310,
                              0.0};
        return one_in(12) ? odd[random() % 8] : sane(size);
    }
    Vec3 any_vector(double size) { return {any(size), any(size), any(size)}; }

    ContactPlane contact() {
        ContactPlane plane;
        Vec3 normal(sane(1.0), sane(1.0), sane(1.0));
        plane.target = static_cast<ContactTarget>(random() % (one_in(20) ? 256 : 6));
        plane.normal = one_in(20) ? any_vector(1.0) : glm::normalize(normal + Vec3(1e-9));
        if (plane.target == ContactTarget::grasp_stop) {
            plane.normal = Vec3(one_in(2) ? 1.0 : -1.0, 0.0, 0.0);
        }
        plane.offset_m = one_in(40) ? any(0.1) : sane(0.1);
        plane.velocity_m_s = one_in(40) ? any_vector(0.5) : Vec3(sane(0.5));
        plane.stiffness_n_m = one_in(40) ? any(2000.0) : std::abs(sane(2000.0));
        plane.damping_n_s_m = one_in(40) ? any(5.0) : std::abs(sane(5.0));
        plane.friction = one_in(40) ? any(1.0) : std::abs(sane(1.0));
        plane.id = static_cast<std::int32_t>(random() % 12);
        return plane;
    }

    void change(HapticCommand &command) {
        command.wrench = {any_vector(10.0), any_vector(0.5), any(0.5)};
        command.wrench_duration_s = one_in(10) ? any(1.0) : std::abs(sane(0.1));
        command.wrench_sequence += random() % 2;
        for (ContactPlane &plane : command.contacts) {
            plane = contact();
        }
        command.contact_count =
            one_in(30) ? static_cast<int>(random()) : static_cast<int>(random() % 9);
        command.contacts_sequence += random() % 2;
        command.forces_enabled = !one_in(200);
        command.arm_count += one_in(50) ? 1U : 0U;
        command.disarm_count += one_in(500) ? 1U : 0U;
        command.clear_fault_count += one_in(50) ? 1U : 0U;
    }
};

} // namespace

TEST_CASE("fuzz: 100000 commands: tensions finite and in [0, max], requests within limits") {
    Fuzz fuzz(2024);
    Bench bench;
    bench.settings.safety.arming_time_s = 0.02;
    bench.start();
    REQUIRE(bench.started == Status::ok);
    const ServoSettings &settings = bench.settings;
    Vec3 p(0.0);
    double grasp = 0.0;
    std::uint64_t forceful = 0;
    for (int i = 0; i < 100'000; ++i) {
        fuzz.change(bench.command);
        p = 0.999 * p + Vec3(fuzz.sane(5e-4), fuzz.sane(5e-4), fuzz.sane(5e-4));
        grasp = 0.999 * grasp + fuzz.sane(5e-3);
        bench.put(spidar::test::moved_by(settings, p, grasp));
        bench.tick(1, fuzz.one_in(100) ? fuzz.any(0.01) : 0.001);
        const ServoSnapshot &now = bench.now();
        for (std::size_t k = 0; k < kStringCount; ++k) {
            REQUIRE(
                (now.tensions_n[k] >= 0.0 && now.tensions_n[k] <= settings.tension.max_tension_n));
            REQUIRE((bench.drive.tensions_n[k] >= 0.0 &&
                     bench.drive.tensions_n[k] <= settings.tension.max_tension_n));
            REQUIRE((bench.drive.currents_a[k] >= 0.0 &&
                     bench.drive.currents_a[k] <= settings.motors.max_current_a[k]));
        }
        REQUIRE(glm::length(now.requested.force_n) <= settings.safety.max_force_n * (1.0 + 1e-9));
        REQUIRE(glm::length(now.requested.moment_nm) <=
                settings.safety.max_moment_nm * (1.0 + 1e-9));
        REQUIRE(std::abs(now.requested.grasp_torque_nm) <=
                settings.safety.max_grasp_torque_nm * (1.0 + 1e-9));
        for (const double value : to_paper(now.achieved)) {
            REQUIRE(std::isfinite(value));
        }
        forceful += glm::length(now.achieved.force_n) > 0.5 ? 1U : 0U;
    }
    CHECK(bench.now().counters.gate_clamps == 0); // the solver never needed the gate's help
    CHECK(bench.now().counters.rejected_requests > 1000);
    CHECK(forceful > 10000); // the fuzz did reach the motors
}

TEST_CASE("a step allocates nothing: a thousand steps with contacts, faults and refusals") {
    Fuzz fuzz(5);
    Bench bench;
    bench.settings.safety.arming_time_s = 0.02;
    bench.start();
    std::uint64_t in_arms = 0;
    const std::size_t before = allocations_of_this_thread();
    for (int i = 0; i < 1000; ++i) {
        fuzz.change(bench.command);
        bench.reading.counts[static_cast<std::size_t>(i % 8)] +=
            fuzz.one_in(300) ? 1000 : i % 3 - 1;
        bench.read_status = fuzz.one_in(50) ? Status::read_timeout : Status::ok;
        bench.tick();
        in_arms += bench.drive.motors_on ? 1U : 0U;
    }
    const std::size_t made = allocations_of_this_thread() - before;
    CHECK(made == 0);
    CHECK(in_arms > 100);
    ::operator delete(::operator new(1));         // no new-expression: those may be optimised away
    CHECK(allocations_of_this_thread() > before); // the trap itself works
}
