// Random commands, hand targets and faults against the simulated device: whatever happens, the invariants of the
// servo loop hold. stress_servo --cases N --seed S; each case can be replayed alone with --cases 1 --seed ITS_SEED.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/loop/servo_loop.h"
#include "device/simulation/simulated_transport.h"
#include "device/step/tension_diagnosis.h"

using namespace spidar;

namespace {

constexpr int kTicks = 60; // one second of play a case
constexpr double kRounding = 1e-9;

struct Random {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
    double up_to(double size) { return std::uniform_real_distribution<double>(0.0, size)(engine); }
    Vec3 vector(double size) { return {within(size), within(size), within(size)}; }
};

struct Result {
    std::string broken; // empty: every invariant held
    double worst_tension_n = 0.0;
    double worst_speed_m_s = 0.0;
    std::uint64_t faults = 0;
    std::uint64_t active_ticks = 0;
};

PlantSettings random_plant(Random &random) {
    PlantSettings plant;
    plant.elastic = !random.one_in(3);
    plant.coulomb_friction_n = random.one_in(2) ? 0.0 : random.up_to(0.1);
    plant.firmness = static_cast<HandFirmness>(random.engine() % 3);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        plant.length_offset_error_m[i] = random.within(0.002);
    }
    return plant;
}

void random_command(Random &random, HapticCommand &command) {
    const double force_n = random.one_in(10) ? 1e3 : 6.0;
    command.wrench = {random.vector(force_n), random.vector(0.2), random.within(0.1)};
    if (random.one_in(20)) {
        command.wrench.force_n.y = std::nan("");
    }
    command.wrench_duration_s = random.up_to(0.1);
    command.wrench_sequence += random.engine() % 2;
    command.contact_count = static_cast<int>(random.engine() % (kMaxContacts + 1));
    for (ContactPlane &plane : command.contacts) {
        plane.normal = glm::normalize(random.vector(1.0) + Vec3(0.0, 1e-6, 0.0));
        plane.target = static_cast<ContactTarget>(random.engine() % 6);
        if (plane.target == ContactTarget::grasp_stop) {
            plane.normal = Vec3(random.one_in(2) ? 1.0 : -1.0, 0.0, 0.0);
        }
        plane.offset_m = random.within(0.1);
        plane.velocity_m_s = random.vector(0.3);
        plane.stiffness_n_m = random.up_to(800.0);
        plane.damping_n_s_m = random.up_to(4.0);
        plane.friction = random.up_to(1.0);
        plane.id = static_cast<std::int32_t>(random.engine() % 10);
    }
    command.contacts_sequence += random.one_in(3) ? 1U : 0U;
    command.forces_enabled = !random.one_in(30);
    command.arm_count += random.one_in(8) ? 1U : 0U;
    command.disarm_count += random.one_in(40) ? 1U : 0U;
    command.clear_fault_count += random.one_in(5) ? 1U : 0U;
}

HandTarget random_target(Random &random) {
    HandTarget target;
    target.position_m = random.vector(0.12);
    const Vec3 turn = random.vector(0.5);
    const double angle = glm::length(turn);
    if (angle > 0.0) {
        target.rotation = glm::mat3_cast(glm::angleAxis(angle, turn / angle));
    }
    target.grasp_angle_rad = random.within(0.8);
    return target;
}

bool finite(const Wrench &wrench) {
    const PaperWrench q = to_paper(wrench);
    return std::all_of(q.begin(), q.end(), [](double value) { return std::isfinite(value); });
}

// The first invariant that does not hold, or "".
std::string broken_invariant(const ServoSettings &settings, const ServoSnapshot &now,
                             const ServoSnapshot &before) {
    const bool motors_may_pull = now.state == DeviceState::arming ||
                                 now.state == DeviceState::active ||
                                 now.state == DeviceState::fading;
    const double slew_n = settings.safety.tension_slew_n_per_ms * 1000.0 / settings.rate_hz;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double tension_n = now.tensions_n[i];
        if (!(tension_n >= 0.0 && tension_n <= settings.tension.max_tension_n)) {
            return "tension outside [0, max]";
        }
        if (!motors_may_pull && tension_n != 0.0) {
            return "tension while the motors must be off";
        }
        if (tension_n - before.tensions_n[i] > slew_n + kRounding) {
            return "tension rose faster than the slew limit";
        }
        if (now.force_scale <= 0.0 && tension_n != 0.0) {
            return "tension at a force scale of zero";
        }
    }
    if (!finite(now.requested) || !finite(now.achieved) ||
        !finite(from_paper(tension_report(settings, now).bias()))) {
        return "a wrench is not finite";
    }
    if (glm::length(now.requested.force_n) > settings.safety.max_force_n + kRounding ||
        glm::length(now.requested.moment_nm) > settings.safety.max_moment_nm + kRounding ||
        std::abs(now.requested.grasp_torque_nm) > settings.safety.max_grasp_torque_nm + kRounding) {
        return "request above its limit";
    }
    const Vec3 &p = now.grip.pose.position_m;
    if (!(glm::length(p) < 1.0) || !std::isfinite(now.grip.frame.grasp_angle_rad) ||
        !std::isfinite(glm::length(now.grip.twist.angular_rad_s))) {
        return "the pose is not finite or far outside the frame";
    }
    const double d = settings.grip.pole_half_length_m;
    if (std::abs(glm::length(now.grip.pose.r1_m) - d) > kRounding ||
        std::abs(glm::length(now.grip.pose.r2_m) - d) > kRounding) {
        return "a pole has changed its length";
    }
    if ((now.state == DeviceState::fault) != (now.fault != Status::ok) &&
        now.state != DeviceState::closed) {
        return "state and fault contradict each other";
    }
    const bool latched = before.state == DeviceState::fault || before.state == DeviceState::closed;
    if (latched && motors_may_pull && now.state != DeviceState::arming) {
        return "forces right after a fault, without arming";
    }
    if (now.counters.gate_clamps != 0) {
        return "the solver handed the gate an impossible tension";
    }
    return {};
}

Result run(std::uint64_t seed) {
    Random random{std::mt19937_64(seed)};
    const PlantSettings plant = random_plant(random);
    auto made = std::make_unique<SimulatedTransport>(plant);
    SimulatedTransport &transport = *made;
    ServoSettings settings;
    settings.safety.arming_time_s = 0.1;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          transport.home_counts(), kPaperMetresPerCount);
    ServoLoop loop(std::move(made));
    Result result;
    if (!usable(loop.start_stepped(settings))) {
        result.broken = "the loop does not start";
        return result;
    }
    HapticCommand command;
    command.forces_enabled = true;
    ServoSnapshot before;
    before.state = DeviceState::arming; // no predecessor: nothing to compare
    for (int tick = 0; tick < kTicks; ++tick) {
        random_command(random, command);
        loop.publish(command);
        if (random.one_in(6)) {
            transport.set_hand_target(random_target(random));
        }
        if (random.one_in(15)) {
            FaultInjection fault;
            fault.fault = static_cast<SimulatedFault>(random.engine() % 7);
            fault.string = static_cast<int>(random.engine() % kStringCount);
            fault.start_s = random.up_to(0.03);
            fault.duration_s = 0.001 + random.up_to(0.05);
            transport.inject(fault);
        }
        for (int cycle = 0; cycle < 16; ++cycle) {
            loop.advance(1, 1000);
            ServoSnapshot now;
            if (!loop.latest(now)) {
                result.broken = "a cycle published nothing";
                return result;
            }
            result.broken = broken_invariant(settings, now, before);
            if (!result.broken.empty()) {
                return result;
            }
            for (const double tension_n : now.tensions_n) {
                result.worst_tension_n = std::max(result.worst_tension_n, tension_n);
            }
            result.faults += now.state == DeviceState::fault && before.state != DeviceState::fault;
            result.active_ticks += now.state == DeviceState::active ? 1U : 0U;
            before = now;
        }
        const PlantTruth truth = transport.truth();
        const double speed_m_s = glm::length(truth.twist.linear_m_s);
        if (!std::isfinite(speed_m_s)) {
            result.broken = "the plant is no longer finite";
            return result;
        }
        result.worst_speed_m_s = std::max(result.worst_speed_m_s, speed_m_s);
    }
    loop.stop();
    return result;
}

} // namespace

int main(int argc, char **argv) {
    std::uint64_t cases = 100;
    std::uint64_t seed = 1;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::uint64_t value = std::strtoull(argv[i + 1], nullptr, 10);
        if (std::strcmp(argv[i], "--cases") == 0) {
            cases = value;
        } else if (std::strcmp(argv[i], "--seed") == 0) {
            seed = value;
        } else {
            std::fprintf(stderr, "usage: stress_servo [--cases N] [--seed S]\n");
            return 2;
        }
    }
    Result worst;
    std::uint64_t worst_seed = seed;
    std::uint64_t faults = 0;
    std::uint64_t active_ticks = 0;
    std::uint64_t failures = 0;
    for (std::uint64_t i = 0; i < cases; ++i) {
        const Result result = run(seed + i);
        faults += result.faults;
        active_ticks += result.active_ticks;
        if (!result.broken.empty()) {
            ++failures;
            std::printf("FAILED: %s; replay: --cases 1 --seed %llu\n", result.broken.c_str(),
                        static_cast<unsigned long long>(seed + i));
        }
        if (result.worst_speed_m_s >= worst.worst_speed_m_s) {
            worst = result;
            worst_seed = seed + i;
        }
    }
    std::printf(
        "%llu cases, %llu faults latched, %llu active cycles; fastest grip %.3f m/s and then up "
        "to %.2f N (replay: --cases 1 --seed %llu)\n",
        static_cast<unsigned long long>(cases), static_cast<unsigned long long>(faults),
        static_cast<unsigned long long>(active_ticks), worst.worst_speed_m_s, worst.worst_tension_n,
        static_cast<unsigned long long>(worst_seed));
    std::printf("%llu passed, %llu failed\n", static_cast<unsigned long long>(cases - failures),
                static_cast<unsigned long long>(failures));
    // A run without forces or without faults has tested nothing.
    return failures == 0 && cases > 0 && active_ticks > 0 ? 0 : 1;
}
