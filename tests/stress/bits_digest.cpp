// One number for the bits of many seeded servo steps and tension problems, at one SIMD level. A change that is meant to
// change no result, such as one of structure, prints the same numbers before and after.
//   bits_digest --cases N --seed S --level plain|avx2     N steps and N problems
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/base/simd_level.h"
#include "core/tension/tension_solver.h"
#include "device/step/servo_step.h"
#include "support/command_line.h"
#include "support/problem_generator.h"
#include "support/servo_step_input.h"

using namespace spidar;

namespace {

// Steps of one device, from switching it on; as in stress_servo_step.
constexpr long kSequence = 10000;

class Digest {
public:
    void add(std::uint64_t word) {
        constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;
        hash_ = (hash_ ^ word) * kOdd;
        hash_ ^= hash_ >> 29U;
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const Vec3 &v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    void add(const Wrench &wrench) {
        add(wrench.force_n);
        add(wrench.moment_nm);
        add(wrench.grasp_torque_nm);
    }
    template <class T, std::size_t kCount>
    void add(const std::array<T, kCount> &values) {
        for (const T &value : values) {
            add(value);
        }
    }
    void add(const CountArray &counts) {
        for (const std::int32_t count : counts) {
            add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(count)));
        }
    }
    void flag(bool value) { add(static_cast<std::uint64_t>(value)); }
    template <class Enum>
    void number(Enum value) {
        add(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
    }
    [[nodiscard]] unsigned long long value() const { return hash_; }

private:
    std::uint64_t hash_ = 1;
};

void add_drive(Digest &digest, const DriveCommand &drive) {
    digest.flag(drive.motors_on);
    digest.flag(drive.clear_faults);
    digest.add(drive.tensions_n);
    digest.add(drive.currents_a);
}

void add_counters(Digest &digest, const ServoCounters &counters) {
    for (const std::uint64_t count :
         {counters.ticks, counters.kinematics_skipped, counters.tension_skipped,
          counters.steps_skipped, counters.cold_starts, counters.bad_samples,
          counters.read_timeouts, counters.rejected_requests, counters.clamped_requests,
          counters.expired_requests, counters.saturated_ticks, counters.slewed_ticks,
          counters.write_failures, counters.reports_missed, counters.old_reports,
          counters.faded_ticks, counters.bad_time_steps, counters.gate_clamps}) {
        digest.add(count);
    }
}

void add_grip(Digest &digest, const GripState &grip) {
    digest.add(grip.pose.position_m);
    digest.add(grip.pose.r1_m);
    digest.add(grip.pose.r2_m);
    for (int column = 0; column < 3; ++column) {
        digest.add(grip.frame.rotation[column]);
    }
    digest.add(grip.frame.grasp_angle_rad);
    digest.add(grip.twist.linear_m_s);
    digest.add(grip.twist.angular_rad_s);
    digest.add(grip.twist.grasp_rate_rad_s);
    digest.add(grip.residual_rms_m);
    digest.add(grip.conditioning);
    digest.number(grip.status);
}

void add_snapshot(Digest &digest, const ServoSnapshot &now) {
    digest.add(now.time_s);
    digest.number(now.state);
    digest.number(now.fault);
    digest.number(now.fault_string);
    add_grip(digest, now.grip);
    digest.number(now.grasp);
    digest.add(now.counts);
    digest.add(now.lengths_m);
    digest.add(now.tensions_n);
    digest.add(now.requested);
    digest.add(now.achieved);
    digest.number(now.at_min_mask);
    digest.number(now.at_max_mask);
    digest.number(now.tension_status);
    for (const double share : {now.force_scale, now.tension_scale, now.safety_scale,
                               now.thermal_share, now.parity_error_m}) {
        digest.add(share);
    }
    digest.flag(now.zero_known);
    for (int i = 0; i < now.contact_count; ++i) {
        const ContactReport &contact = now.contacts[static_cast<std::size_t>(i)];
        digest.number(contact.id);
        digest.add(contact.impulse_ns);
        digest.add(contact.grasp_impulse_nms);
        digest.flag(contact.touching);
    }
    digest.add(now.injected_j);
    add_counters(digest, now.counters);
    digest.number(now.buttons);
}

void add_events(Digest &digest, const ServoStep &step) {
    for (const DeviceEvent &event : step.events()) {
        digest.number(event.kind);
        digest.number(event.string);
        digest.add(event.time_s);
        digest.add(event.value);
    }
}

unsigned long long digest_of_steps(long cases, std::uint64_t seed, SimdLevel level) {
    Digest digest;
    for (long begin = 0; begin < cases; begin += kSequence) {
        test::ServoStepInput input(seed, static_cast<std::uint64_t>(begin / kSequence));
        input.settings.tension.simd = level;
        const auto step = std::make_unique<ServoStep>();
        digest.number(step->configure(input.settings));
        for (long at = begin; at < begin + kSequence && at < cases; ++at) {
            input.next(step->snapshot());
            const DriveCommand drive = step->step(input.read_status, input.reading, input.command,
                                                  input.dt_s, input.simulated);
            add_drive(digest, drive);
            add_snapshot(digest, step->snapshot());
            add_events(digest, *step);
        }
    }
    return digest.value();
}

void add_solution(Digest &digest, const TensionSolution &solution) {
    digest.add(solution.tensions_n);
    for (const StringBound bound : solution.active) {
        digest.number(bound);
    }
    digest.add(solution.largest_error_n);
    digest.number(solution.iterations);
    digest.number(solution.status);
}

unsigned long long digest_of_problems(long cases, std::uint64_t seed, SimdLevel level) {
    Digest digest;
    TensionSettings settings;
    settings.simd = level;
    TensionSolver solver; // the same problems as ticks of one device
    (void)solver.configure(settings);
    for (long i = 0; i < cases; ++i) {
        const TensionProblem problem =
            test::random_problem(seed + static_cast<std::uint64_t>(i)).problem;
        const TensionSolution solution = solve_tension_problem(problem, nullptr, level);
        add_solution(digest, solution);
        add_solution(digest, solve_tension_problem(problem, &solution.active, level));
        const TensionResult result = solver.update(problem.matrix, problem.wrench);
        digest.add(result.tensions_n);
        digest.number(result.at_min_mask);
        digest.number(result.at_max_mask);
        digest.number(result.status);
    }
    return digest.value();
}

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 1000000);
    const long seed = test::whole_option(argc, argv, "--seed", 1);
    const char *const name = test::option_text(argc, argv, "--level");
    const bool plain = name == nullptr || std::strcmp(name, "plain") == 0;
    if (cases <= 0 || seed < 0 || (!plain && std::strcmp(name, "avx2") != 0)) {
        std::fprintf(stderr, "usage: bits_digest [--cases N>0] [--seed S] [--level plain|avx2]\n");
        return 2;
    }
    const SimdLevel level = plain ? SimdLevel::plain : SimdLevel::avx2;
    if (!supports(level)) {
        std::fprintf(stderr, "bits_digest: this processor has no AVX2\n");
        return 2;
    }
    const auto start = static_cast<std::uint64_t>(seed);
    std::printf("%ld servo steps:       %016llx\n", cases, digest_of_steps(cases, start, level));
    std::printf("%ld tension problems:  %016llx\n", cases, digest_of_problems(cases, start, level));
    return 0;
}
