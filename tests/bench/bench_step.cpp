#include "bench/bench_step.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>

#include "bench/allocation_count.h"
#include "bench/bench_recording.h"
#include "bench/daqp_clock.h"
#include "bench/repeated_times.h"
#include "core/geometry/wrench_matrix.h"
#include "core/kinematics/forward_kinematics.h"
#include "core/tension/tension_solver.h"
#include "device/loop/servo_loop.h"
#include "device/simulation/simulated_transport.h"
#include "device/step/servo_step.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kTicks = 20000;
constexpr double kPeriod_s = 1e-3;
// Long enough for arming and every ramp.
constexpr std::size_t kWarmUpTicks = 3000;
// A step that allocates even once has broken its promise.
constexpr std::size_t kAllocationsAllowed = 0;

Mat3 turn(double x, double y, double z) {
    const Mat3 rx(1, 0, 0, 0, std::cos(x), std::sin(x), 0, -std::sin(x), std::cos(x));
    const Mat3 ry(std::cos(y), 0, -std::sin(y), 0, 1, 0, std::sin(y), 0, std::cos(y));
    const Mat3 rz(std::cos(z), std::sin(z), 0, -std::sin(z), std::cos(z), 0, 0, 0, 1);
    return rz * ry * rx;
}

// A hand that moves everywhere at up to 0.7 m/s and 2.5 rad/s.
GripPose moving_pose(const GripGeometry &grip, double t) {
    const Vec3 position(0.15 * std::sin(3.1 * t), 0.15 * std::sin(2.3 * t + 1.0),
                        0.12 * std::sin(2.9 * t + 2.0));
    return make_pose(
        grip, position,
        turn(0.6 * std::sin(4.1 * t), 0.6 * std::sin(3.7 * t + 1.0), 0.5 * std::sin(3.3 * t + 2.0)),
        -0.5 * std::sin(2.1 * t));
}

CountArray counts_of(const ServoSettings &settings, const GripPose &pose) {
    const StringArray lengths = string_lengths(settings.frame, settings.grip, pose);
    const StringArray home =
        string_lengths(settings.frame, settings.grip, rest_pose(settings.grip));
    CountArray counts{};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        counts[i] =
            static_cast<std::int32_t>(std::lround((lengths[i] - home[i]) / kPaperMetresPerCount));
    }
    return counts;
}

ServoSettings ideal_settings() {
    ServoSettings settings;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          {}, kPaperMetresPerCount);
    return settings;
}

void add_row(std::vector<BenchRow> &rows, const char *name, const char *mode,
             const RepeatedTimes &times) {
    BenchRow row;
    row.method = name;
    row.set = "step";
    row.mode = mode;
    times.fill(row);
    rows.push_back(row);
}

struct StepCase {
    const char *name;
    bool moving;
    bool forces;
    int contacts;
    bool asks = true; // the game asks for a wrench each frame
};

// All ticks of one case, from a fresh step; DAQP takes its turn after each block of them.
class StepRun {
public:
    StepRun(const ServoSettings &settings, const StepCase &step_case)
        : settings_(settings), step_case_(step_case) {
        command_.forces_enabled = step_case.forces;
        command_.contact_count = step_case.contacts;
        for (int i = 0; i < step_case.contacts; ++i) {
            ContactPlane &plane = command_.contacts[static_cast<std::size_t>(i)];
            const double angle = 0.7 * i;
            plane.normal = Vec3(std::sin(angle), std::cos(angle), 0.0);
            plane.offset_m = -0.02;
            plane.id = i;
        }
    }

    bool run(std::size_t number, std::size_t ticks, RepeatedTimes &times, DaqpClock &daqp) {
        auto step = std::make_unique<ServoStep>();
        if (!usable(step->configure(settings_))) {
            return false;
        }
        std::size_t allocated = 0;
        std::size_t daqp_from = 0;
        for (std::size_t tick = 0; tick < kWarmUpTicks + ticks; ++tick) {
            prepare(tick);
            const auto call = [&] { step->step(Status::ok, reading_, command_, kPeriod_s, true); };
            if (tick < kWarmUpTicks) {
                call();
                continue;
            }
            const std::size_t timed = tick - kWarmUpTicks;
            const std::size_t before = allocations().count;
            times.time(timed, call);
            allocated += allocations().count - before;
            // Its turns begin elsewhere in each run: no tick finds the caches cold in all of them.
            if ((timed + 1 + number * kBlock / kRuns) % kBlock == 0 || timed + 1 == ticks) {
                daqp.time_block(daqp_from, timed + 1);
                daqp_from = timed + 1;
            }
        }
        if (allocated > kAllocationsAllowed) {
            std::printf("  FAILED: %zu allocations inside the steps\n", allocated);
            return false;
        }
        const DeviceState wanted = step_case_.forces ? DeviceState::active : DeviceState::connected;
        if (step->snapshot().state != wanted) {
            std::printf("  FAILED: state %s\n", describe(step->snapshot().state));
            return false;
        }
        return true;
    }

private:
    void prepare(std::size_t tick) {
        const double t = kPeriod_s * static_cast<double>(tick);
        reading_.counts =
            counts_of(settings_, moving_pose(settings_.grip, step_case_.moving ? t : 0.3));
        if (tick % 16 == 0 && step_case_.forces && step_case_.asks) {
            ++command_.wrench_sequence;
            command_.wrench = {Vec3(std::sin(10.0 * t), 1.0, 0.0), Vec3(0.0, 0.02, 0.0), 0.01};
            command_.wrench_duration_s = 0.1;
            ++command_.contacts_sequence;
        }
    }

    const ServoSettings &settings_;
    StepCase step_case_;
    DeviceReading reading_;
    HapticCommand command_;
};

bool run_step_case(const ServoSettings &settings, const StepCase &step_case, std::size_t ticks,
                   DaqpClock &daqp, std::vector<BenchRow> &rows) {
    RepeatedTimes times(ticks);
    bool good = true;
    for (std::size_t run = 0; run < kRuns; ++run) {
        good = StepRun(settings, step_case).run(run, ticks, times, daqp) && good;
    }
    add_row(rows, step_case.name, step_case.moving ? "moving" : "at rest", times);
    return good;
}

void run_computations(const ServoSettings &settings, std::size_t ticks,
                      std::vector<BenchRow> &rows) {
    RepeatedTimes warm(ticks);
    RepeatedTimes cold(ticks);
    RepeatedTimes matrix_times(ticks);
    RepeatedTimes tension(ticks);
    RepeatedTimes forces_alone(ticks);
    TensionSettings masked = settings.tension;
    masked.dof_mask = 0b111;
    for (int run = 0; run < kRuns; ++run) {
        ForwardKinematics kinematics;
        TensionSolver solver;
        TensionSolver force_solver;
        kinematics.configure(settings.frame, settings.grip);
        solver.configure(settings.tension);
        force_solver.configure(masked);
        for (std::size_t tick = 0; tick < ticks; ++tick) {
            const double t = kPeriod_s * static_cast<double>(tick);
            const StringArray lengths = lengths_from_counts(
                settings.strings, counts_of(settings, moving_pose(settings.grip, t)));
            KinematicsResult result;
            warm.time(tick, [&] { result = kinematics.update(lengths); });
            ForwardKinematics fresh = kinematics;
            cold.time(tick, [&] { fresh.solve_cold(lengths); });
            WrenchMatrix matrix;
            matrix_times.time(
                tick, [&] { matrix = wrench_matrix(settings.frame, settings.grip, result.pose); });
            const PaperWrench wrench = {
                2.0 * std::sin(3.0 * t), std::cos(2.0 * t), 0.5, 0.02, 0.01, 0.0, 0.02};
            tension.time(tick, [&] { solver.update(matrix, wrench); });
            forces_alone.time(tick, [&] { force_solver.update(matrix, wrench); });
        }
    }
    add_row(rows, "forward kinematics", "warm", warm);
    add_row(rows, "forward kinematics", "cold", cold);
    add_row(rows, "wrench matrix", "-", matrix_times);
    add_row(rows, "tension solver", "warm", tension);
    add_row(rows, "forces alone, tension solver", "warm", forces_alone);
}

bool report_memory(const ServoSettings &settings) {
    const std::size_t before = allocations().bytes;
    auto transport = std::make_unique<SimulatedTransport>(PlantSettings{});
    auto loop = std::make_unique<ServoLoop>(std::move(transport));
    if (!usable(loop->start_stepped(settings))) {
        return false;
    }
    const std::size_t after_start = allocations().bytes;
    loop->advance(1, 1); // 1000 cycles
    const std::size_t after_run = allocations().bytes;
    std::printf("\nmemory of one open device: %.1f KiB at start, %zu B more in 1000 cycles "
                "(ServoStep %zu B, HapticCommand %zu B, ServoSnapshot %zu B)\n",
                static_cast<double>(after_start - before) / 1024.0, after_run - after_start,
                sizeof(ServoStep), sizeof(HapticCommand), sizeof(ServoSnapshot));
    loop->stop();
    return after_run == after_start;
}

} // namespace

int bench_step(std::vector<BenchRow> &rows) {
    const ServoSettings settings = ideal_settings();
    const std::size_t ticks = limited(kTicks);
    const std::size_t first = rows.size();
    DaqpClock daqp(ticks);
    bool good = true;
    for (const StepCase &step_case :
         {StepCase{"step, forces off", false, false, 0},
          StepCase{"step, forces off", true, false, 0},
          StepCase{"step, nothing asked", false, true, 0, false},
          StepCase{"step, wrench", false, true, 0}, StepCase{"step, wrench", true, true, 0},
          StepCase{"step, wrench and 4 contacts", true, true, 4},
          StepCase{"step, wrench and 8 contacts", true, true, kMaxContacts}}) {
        good = run_step_case(settings, step_case, ticks, daqp, rows) && good;
    }
    run_computations(settings, ticks, rows);
    if (daqp.ready()) {
        const BenchRow warm = daqp.warm_row();
        for (std::size_t i = first; i < rows.size(); ++i) {
            rows[i].ratio_to_daqp = rows[i].median_ns / warm.median_ns;
        }
        rows.push_back(warm);
    }
    print_header("one servo step, and its parts; ratios to one warm tension solve by DAQP");
    for (std::size_t i = first; i < rows.size(); ++i) {
        print_row(rows[i]);
    }
    good = report_memory(settings) && good;
    good = bench_recording(rows) == 0 && good;
    return good ? 0 : 1;
}

} // namespace spidar::bench
