// The servo step alone, without a plant, under any input: encoders and links that fail, games that ask for nonsense, odd
// clocks, every mask. After each step its invariants are checked; quick enough for 10^9 of them in an hour or so.
//   stress_servo_step --cases STEPS --seed S [--first STEP]; a step replays from the beginning of its sequence.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include <glm/geometric.hpp>

#include "core/base/simd_level.h"
#include "core/geometry/wrench_matrix.h"
#include "device/safety/monitors/workspace_guard.h"
#include "device/step/servo_step.h"
#include "support/command_line.h"
#include "support/servo_step_input.h"
#include "support/snapshot_bits.h"

using namespace spidar;

namespace {

// Steps of one device, from switching it on.
constexpr long kSequence = 10000;
// Every so many steps a copy of the state takes the same step, without skipping anything.
constexpr long kTwinEvery = 16;
constexpr double kRounding = 1e-9;
// As the servo step takes time steps: others are replaced by 1 / rate.
constexpr double kShortest_s = 1e-6;
constexpr double kLongest_s = 0.05;
// A pole's length after all steps of the kinematics.
constexpr double kPole_m = 1e-9;
// When nothing is asked the passivity controller may still damp, by what it takes for the grip's speed: no more than
// the fastest motion of so long ago. Below kRest_n nobody asks why.
constexpr double kDamperMemory_s = 0.1;
constexpr double kRest_n = 0.2;

bool finite(const Vec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const Wrench &wrench) {
    return finite(wrench.force_n) && finite(wrench.moment_nm) &&
           std::isfinite(wrench.grasp_torque_nm);
}

bool within(double value, double low, double high) {
    return value >= low && value <= high;
}

// For how long something has not come, and how near to its limits a quantity was (1: at the limit).
struct Watch {
    double unread_s = 0.0;
    double unbeaten_s = 0.0;
    double unasked_s = 0.0;
    double fastest_m_s = 0.0; // of the grip, fading
    double rise = 0.0;
    double tension = 0.0;
    double request = 0.0;
};

class Sequence {
public:
    Sequence(std::uint64_t seed, std::uint64_t number)
        : input_(seed, number), step_(std::make_unique<ServoStep>()),
          twin_(std::make_unique<ServoStep>()) {
        const SimdLevel level = number % 2 == 0 ? SimdLevel::plain : SimdLevel::avx2;
        input_.settings.tension.simd = supports(level) ? level : SimdLevel::plain;
        configured_ = usable(step_->configure(input_.settings));
        wall_.configure(input_.settings);
        before_ = step_->snapshot();
    }

    // What does not hold after one more step; null when all does.
    const char *run(Watch &worst) {
        if (!configured_) {
            return "the settings are refused";
        }
        const HapticCommand last = edges_of(input_.command);
        input_.next(before_);
        const bool good = within(input_.dt_s, kShortest_s, kLongest_s);
        dt_s_ = good ? input_.dt_s : 1.0 / input_.settings.rate_hz;
        const bool twin = ++taken_ % kTwinEvery == 0;
        if (twin) {
            *twin_ = *step_;
        }
        drive_ = take(*step_);
        const ServoSnapshot &now = step_->snapshot();
        count_silence(last);
        const char *broken = check_tensions(now);
        broken = broken != nullptr ? broken : check_wrenches(now);
        broken = broken != nullptr ? broken : check_pose(now);
        broken = broken != nullptr ? broken : check_state(now, last);
        broken = broken != nullptr ? broken : check_reports(now);
        if (broken == nullptr && twin) {
            broken = check_twin(now);
        }
        worst.rise = std::fmax(worst.rise, watch_.rise);
        worst.tension = std::fmax(worst.tension, watch_.tension);
        worst.request = std::fmax(worst.request, watch_.request);
        before_ = now;
        return broken;
    }

    [[nodiscard]] const ServoSnapshot &now() const { return before_; }

private:
    // The numbers of a command that the next one is compared by.
    static HapticCommand edges_of(const HapticCommand &command) {
        HapticCommand edges;
        edges.arm_count = command.arm_count;
        edges.disarm_count = command.disarm_count;
        edges.clear_fault_count = command.clear_fault_count;
        edges.heartbeat = command.heartbeat;
        edges.wrench_sequence = command.wrench_sequence;
        edges.contacts_sequence = command.contacts_sequence;
        edges.coupling_sequence = command.coupling_sequence;
        edges.effects_sequence = command.effects_sequence;
        return edges;
    }

    DriveCommand take(ServoStep &step) const {
        return step.step(input_.read_status, input_.reading, input_.command, input_.dt_s,
                         input_.simulated);
    }

    void count_silence(const HapticCommand &last) {
        const HapticCommand &now = input_.command;
        const bool beaten = now.heartbeat == 0 || now.heartbeat != last.heartbeat;
        const bool asked = now.wrench_sequence != last.wrench_sequence ||
                           now.contacts_sequence != last.contacts_sequence ||
                           now.coupling_sequence != last.coupling_sequence ||
                           now.effects_sequence != last.effects_sequence;
        watch_.unread_s = input_.read_status == Status::read_timeout ? watch_.unread_s + dt_s_ : 0;
        watch_.unbeaten_s = beaten ? 0.0 : watch_.unbeaten_s + dt_s_;
        watch_.unasked_s = asked ? 0.0 : watch_.unasked_s + dt_s_;
    }

    const char *check_tensions(const ServoSnapshot &now) {
        const ServoSettings &settings = input_.settings;
        const double most_n = settings.tension.max_tension_n;
        const double slew_n = 1e3 * settings.safety.tension_slew_n_per_ms * dt_s_;
        const bool may_pull = now.state == DeviceState::arming ||
                              now.state == DeviceState::active ||
                              now.state == DeviceState::fading || now.state == DeviceState::taut ||
                              now.state == DeviceState::calibrated;
        if (drive_.motors_on && !may_pull) {
            return "motors on in a state that has none";
        }
        if (drive_.motors_on && drive_.clear_faults) {
            return "the device may forget its faults with motors on";
        }
        watch_.rise = 0.0;
        watch_.tension = 0.0;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double tension_n = now.tensions_n[i];
            if (!within(tension_n, 0.0, most_n) ||
                !within(drive_.tensions_n[i], 0.0, most_n / settings.motors.tension_gain[i]) ||
                !within(drive_.currents_a[i], 0.0, settings.motors.max_current_a[i])) {
                return "a tension or current outside [0, max], or not a number";
            }
            if (!drive_.motors_on &&
                (tension_n != 0.0 || drive_.tensions_n[i] != 0.0 || drive_.currents_a[i] != 0.0)) {
                return "a tension while the motors are off";
            }
            const double change_n = tension_n - before_.tensions_n[i];
            if (change_n > slew_n + kRounding ||
                (drive_.motors_on && -change_n > slew_n + kRounding)) {
                return "a tension changed faster than the slew limit";
            }
            watch_.rise = std::fmax(watch_.rise, change_n / slew_n);
            watch_.tension = std::fmax(watch_.tension, tension_n / most_n);
        }
        return now.counters.gate_clamps == 0 ? nullptr
                                             : "the gate was handed an impossible tension";
    }

    const char *check_wrenches(const ServoSnapshot &now) {
        const SafetySettings &safety = input_.settings.safety;
        if (!finite(now.requested) || !finite(now.achieved)) {
            return "a wrench is not finite";
        }
        const double force_n = glm::length(now.requested.force_n);
        const double moment_nm = glm::length(now.requested.moment_nm);
        const double grasp_nm = std::fabs(now.requested.grasp_torque_nm);
        if (!(force_n <= safety.max_force_n * (1.0 + kRounding)) ||
            !(moment_nm <= safety.max_moment_nm * (1.0 + kRounding)) ||
            !(grasp_nm <= safety.max_grasp_torque_nm * (1.0 + kRounding))) {
            return "a request above its limit";
        }
        watch_.request = safety.max_force_n > 0.0 ? force_n / safety.max_force_n : 0.0;
        const bool quiet =
            watch_.unasked_s > ServoStepInput::kLongestRequest_s + safety.contacts_gone_s;
        const double speed_m_s =
            glm::distance(now.grip.pose.position_m, before_.grip.pose.position_m) / dt_s_;
        watch_.fastest_m_s =
            std::fmax(speed_m_s, watch_.fastest_m_s * std::exp(-dt_s_ / kDamperMemory_s));
        const RenderSettings &render = input_.settings.render;
        const double damper_n =
            render.passivity_share * render.max_damping_n_s_m * watch_.fastest_m_s;
        if (quiet && render.compensated_mass_kg == 0.0 && !(wall_.beyond_m(now.grip) > 0.0) &&
            force_n > kRest_n + damper_n) {
            return "a force long after the last request";
        }
        if (taken_ % kTwinEvery == 1 && drive_.motors_on && now.state != DeviceState::taut) {
            const WrenchMatrix matrix =
                wrench_matrix(input_.settings.frame, input_.settings.grip, now.grip.pose);
            const Wrench given = from_paper(apply(matrix, now.tensions_n));
            if (!(glm::distance(given.force_n, now.achieved.force_n) <= kRounding) ||
                !(glm::distance(given.moment_nm, now.achieved.moment_nm) <= kRounding) ||
                !(std::fabs(given.grasp_torque_nm - now.achieved.grasp_torque_nm) <= kRounding)) {
                return "the wrench reported is not the one that the tensions give";
            }
        }
        return nullptr;
    }

    [[nodiscard]] const char *check_pose(const ServoSnapshot &now) const {
        const GripState &grip = now.grip;
        const double d = input_.settings.grip.pole_half_length_m;
        if (!(glm::length(grip.pose.position_m) < 1.0) ||
            !(std::fabs(glm::length(grip.pose.r1_m) - d) <= kPole_m) ||
            !(std::fabs(glm::length(grip.pose.r2_m) - d) <= kPole_m)) {
            return "a pose that no grip can have";
        }
        if (!finite(grip.twist.linear_m_s) || !finite(grip.twist.angular_rad_s) ||
            !std::isfinite(grip.twist.grasp_rate_rad_s) ||
            !std::isfinite(grip.frame.grasp_angle_rad) || !finite(grip.frame.rotation[0]) ||
            !finite(grip.frame.rotation[1]) || !finite(grip.frame.rotation[2])) {
            return "a velocity or a rotation is not finite";
        }
        return nullptr;
    }

    [[nodiscard]] const char *check_state(const ServoSnapshot &now,
                                          const HapticCommand &last) const {
        const HapticCommand &command = input_.command;
        const bool forces = now.state == DeviceState::arming || now.state == DeviceState::active;
        if (forces && (!command.forces_enabled || command.disarm_count != last.disarm_count)) {
            return "armed against the game's will";
        }
        if ((now.state == DeviceState::fault) != (now.fault != Status::ok) &&
            now.state != DeviceState::closed) {
            return "state and fault contradict each other";
        }
        if (before_.state == DeviceState::fault && now.state != DeviceState::fault &&
            now.state != DeviceState::closed &&
            command.clear_fault_count == last.clear_fault_count) {
            return "a latched fault went away by itself";
        }
        if (forces && before_.state != DeviceState::arming &&
            before_.state != DeviceState::active && !input_.simulated && !now.zero_known) {
            return "armed without a zero";
        }
        const double slack_s = 2.0 * kLongest_s;
        if (drive_.motors_on &&
            watch_.unread_s > input_.settings.safety.read_timeout_fault_s + slack_s) {
            return "motors on long after the last report";
        }
        if (forces && watch_.unbeaten_s > input_.settings.safety.game_timeout_s + slack_s) {
            return "forces long after the game's last sign of life";
        }
        return nullptr;
    }

    [[nodiscard]] const char *check_reports(const ServoSnapshot &now) const {
        if (now.counters.ticks != static_cast<std::uint64_t>(taken_)) {
            return "a step was not counted";
        }
        if (!within(now.force_scale, 0.0, 1.0) || !within(now.tension_scale, 0.0, 1.0) ||
            !within(now.safety_scale, 0.0, 1.0) || !(now.thermal_share >= 0.0) ||
            !(now.parity_error_m >= 0.0) || !within(now.contact_count, 0, kMaxContacts)) {
            return "a report is out of its range";
        }
        double sum = 0.0;
        for (const double energy_j : now.injected_j) {
            sum += energy_j;
        }
        for (int i = 0; i < now.contact_count; ++i) {
            const ContactReport &contact = now.contacts[static_cast<std::size_t>(i)];
            sum += contact.impulse_ns.x + contact.impulse_ns.y + contact.impulse_ns.z +
                   contact.grasp_impulse_nms;
        }
        return std::isfinite(sum) ? nullptr : "an energy or an impulse is not finite";
    }

    // Same input, same bits, whether or not something was skipped.
    const char *check_twin(const ServoSnapshot &now) {
        twin_->forget_settled();
        const DriveCommand drive = take(*twin_);
        ServoSnapshot told = now;
        told.counters.tension_skipped = twin_->snapshot().counters.tension_skipped;
        told.counters.steps_skipped = twin_->snapshot().counters.steps_skipped;
        const bool same =
            drive.motors_on == drive_.motors_on && drive.clear_faults == drive_.clear_faults &&
            drive.tensions_n == drive_.tensions_n && drive.currents_a == drive_.currents_a &&
            test::bits_of(told) == test::bits_of(twin_->snapshot());
        return same ? nullptr : "the same step without skipping gives other bits";
    }

    using ServoStepInput = test::ServoStepInput;

    ServoStepInput input_;
    std::unique_ptr<ServoStep> step_;
    std::unique_ptr<ServoStep> twin_;
    WorkspaceGuard wall_;
    bool configured_ = false;
    long taken_ = 0;
    double dt_s_ = 1e-3;
    DriveCommand drive_;
    ServoSnapshot before_;
    Watch watch_;
};

struct Total {
    long active = 0;
    long faults = 0;
    long pulling = 0; // a request and a tension above the least
    std::uint64_t seen_states = 0;
    std::uint64_t refused = 0;
    std::uint64_t skipped = 0;
    std::uint64_t rested = 0;
    std::uint64_t saturated = 0;
    std::uint64_t slewed = 0;
    long failures = 0;
    Watch worst;
    long worst_at = 0;

    void add(const ServoCounters &counters) {
        refused += counters.rejected_requests;
        skipped += counters.tension_skipped;
        rested += counters.steps_skipped;
        saturated += counters.saturated_ticks;
        slewed += counters.slewed_ticks;
    }
};

// Steps [from, to) of the sequence that begins at step `begin`, after all before them.
void run_sequence(std::uint64_t seed, long begin, long from, long to, Total &total) {
    Sequence sequence(seed, static_cast<std::uint64_t>(begin / kSequence));
    DeviceState before = DeviceState::closed;
    for (long at = begin; at < to; ++at) {
        Watch reached;
        const char *const broken = sequence.run(reached);
        const ServoSnapshot &now = sequence.now();
        if (broken != nullptr) {
            ++total.failures;
            std::printf("FAILED: %s, state \"%s\"; replay: --seed %llu --first %ld --cases %ld\n",
                        broken, describe(now.state), static_cast<unsigned long long>(seed), begin,
                        at + 1 - begin);
            return; // what follows from a broken state says nothing
        }
        if (at < from) {
            continue;
        }
        total.active += now.state == DeviceState::active ? 1 : 0;
        total.pulling += now.requested.force_n != Vec3(0.0) ? 1 : 0;
        total.faults += now.state == DeviceState::fault && before != DeviceState::fault ? 1 : 0;
        total.seen_states |= 1ULL << static_cast<unsigned>(now.state);
        before = now.state;
        if (reached.request > total.worst.request) {
            total.worst = reached;
            total.worst_at = at;
        }
    }
    total.add(sequence.now().counters);
}

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 1000000);
    const long seed = test::whole_option(argc, argv, "--seed", 1);
    const long first = test::whole_option(argc, argv, "--first", 0);
    if (cases <= 0 || first < 0 || seed < 0) {
        std::fprintf(stderr,
                     "--cases is %ld, --first is %ld, --seed is %ld; give a positive number of "
                     "steps, and 0 or more.\n",
                     cases, first, seed);
        return 2;
    }
    Total total;
    for (long at = first; at < first + cases;) {
        const long begin = at - at % kSequence;
        const long end = std::min(begin + kSequence, first + cases);
        run_sequence(static_cast<std::uint64_t>(seed), begin, at, end, total);
        at = end;
    }
    std::printf("stress_servo_step: %ld steps from %ld, seed %ld: %ld active, %ld with a request, "
                "%ld faults latched, %llu requests refused, %llu solves and %llu whole steps "
                "skipped, %llu saturated, "
                "%llu slewed; largest request %.9f of its limit, with tensions up to %.9f of "
                "theirs (--first %ld --cases 1); %ld failures\n",
                cases, first, seed, total.active, total.pulling, total.faults,
                static_cast<unsigned long long>(total.refused),
                static_cast<unsigned long long>(total.skipped),
                static_cast<unsigned long long>(total.rested),
                static_cast<unsigned long long>(total.saturated),
                static_cast<unsigned long long>(total.slewed), total.worst.request,
                total.worst.tension, total.worst_at, total.failures);
    // A long run without forces, faults or skips has tested nothing.
    constexpr long kLong = 100000;
    const bool tested =
        cases < kLong || (total.active > cases / 4 && total.faults > 0 &&
                          total.pulling > cases / 8 && total.skipped > 0 && total.rested > 0);
    if (!tested) {
        std::printf("FAILED: too few steps with forces, faults or skips\n");
    }
    return total.failures == 0 && tested ? 0 : 1;
}
