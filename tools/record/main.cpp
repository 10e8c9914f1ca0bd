// spidar_record info|csv|verify FILE: what is in a recording, as a table, and whether it replays to the bit.
//   info    settings, build, length, events, what is missing or damaged
//   csv     one row a cycle on stdout; wrenches only where this build replays the recording to the bit
//   verify  replays it; exit code 0 only when every cycle gives the recorded bits and none is missing
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "core/calibration/string_calibration.h"
#include "device/contract/dof_lanes.h"
#include "device/loop/servo_loop.h"
#include "device/recording/replay.h"

using namespace spidar;

namespace {

constexpr int kWrong = 1; // the recording is not what was asked for
constexpr int kUsage = 2;

int usage() {
    std::fprintf(stderr, "usage: spidar_record info|csv|verify FILE\n");
    return kUsage;
}

int complain(const std::string &problem) {
    std::fprintf(stderr, "spidar_record: %s\n", problem.c_str());
    return kWrong;
}

unsigned long long whole(std::uint64_t value) {
    return value;
}

// The end of a file: 0, or why it is not a good one.
int end_of(const RecordingReader &reader) {
    if (!reader.damage().empty()) {
        return complain(reader.damage());
    }
    return 0;
}

bool same_event(const RecordedCycle &a, const RecordedCycle &b) {
    return a.state == b.state && a.fault == b.fault && a.grasp == b.grasp &&
           a.input.reading.buttons == b.input.reading.buttons;
}

const char *describe(GraspPhase phase) {
    switch (phase) {
    case GraspPhase::open:
        return "open";
    case GraspPhase::grasped:
        return "grasped";
    case GraspPhase::over_closed:
        return "over-closed";
    }
    return "unknown";
}

int info(const std::string &path) {
    RecordingReader reader;
    const std::string problem = reader.open(path);
    if (!problem.empty()) {
        return complain(problem);
    }
    const RecordingInfo &about = reader.info();
    const std::string replay = why_no_replay(about);
    std::printf("version %s, started %s, vector level %s, %g Hz\n", about.version.c_str(),
                about.started_utc.c_str(), describe(about.settings.tension.simd),
                about.settings.rate_hz);
    std::printf("replay by this build: %s\n", replay.empty() ? "yes, to the bit" : replay.c_str());
    RecordedCycle cycle;
    RecordedCycle before;
    double time_s = 0.0;
    std::uint64_t segments = 0;
    std::uint64_t commands = 0;
    while (reader.next(cycle)) {
        time_s += cycle.input.dt_s;
        segments += cycle.segment_start ? 1 : 0;
        commands += cycle.command_is_new ? 1 : 0;
        if (cycle.segment_start || !same_event(cycle, before)) {
            std::printf("%12.4f s  cycle %llu: %s Grasp %s, buttons %u.", time_s, whole(cycle.tick),
                        describe(cycle.state), describe(cycle.grasp), cycle.input.reading.buttons);
            if (cycle.fault != Status::ok) {
                std::printf(" %s", describe(cycle.fault));
            }
            std::printf("%s\n", cycle.segment_start ? " (segment starts)" : "");
        }
        before = cycle;
    }
    std::printf("%llu cycles, %.3f s, %llu segments, %llu commands, %llu cycles missing\n",
                whole(reader.cycles()), time_s, whole(segments), whole(commands),
                whole(reader.lost()));
    return end_of(reader);
}

void print_head() {
    std::printf("tick,dt_s,segment_start,read_status,write_status,state,fault,fault_string,grasp_"
                "phase,buttons,command_is_new");
    for (const char *name : {"count", "length_m", "tension_n"}) {
        for (int i = 0; i < kStringCount; ++i) {
            std::printf(",%s_%d", name, i);
        }
    }
    std::printf(",x_m,y_m,z_m,grasp_angle_rad,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,"
                "grasp_rate_rad_s,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm,grasp_nm,given_fx_n,given_fy_n,"
                "given_fz_n,given_mx_nm,given_my_nm,given_mz_nm,given_grasp_nm\n");
}

void print_recorded(const RecordedCycle &cycle, const StringCalibration &strings) {
    constexpr double kNewton = 1e-3; // from mN
    std::printf("%llu,%.9g,%d,%d,%d,%d,%d,%d,%d,%u,%d", whole(cycle.tick), cycle.input.dt_s,
                cycle.segment_start, static_cast<int>(cycle.input.read_status),
                static_cast<int>(cycle.input.write_status), static_cast<int>(cycle.state),
                static_cast<int>(cycle.fault), cycle.fault_string, static_cast<int>(cycle.grasp),
                cycle.input.reading.buttons, cycle.command_is_new);
    for (const std::int32_t count : cycle.input.reading.counts) {
        std::printf(",%d", count);
    }
    for (const double length_m : lengths_from_counts(strings, cycle.input.reading.counts)) {
        std::printf(",%.7f", length_m);
    }
    for (const std::int32_t tension_mn : cycle.tensions_mn) {
        std::printf(",%.3f", kNewton * tension_mn);
    }
}

void print_lanes(const DofLanes &row) {
    for (const double value : row) {
        std::printf(",%.6g", value);
    }
}

void print_replayed(const ServoSnapshot &now, bool wrenches) {
    const Vec3 &p = now.grip.pose.position_m;
    std::printf(",%.8f,%.8f,%.8f,%.7f", p.x, p.y, p.z, now.grip.frame.grasp_angle_rad);
    print_lanes(lanes(now.grip.twist));
    if (!wrenches) {
        std::printf("%s", std::string(2 * kDofCount, ',').c_str());
        return;
    }
    print_lanes(lanes(now.requested));
    print_lanes(lanes(now.achieved));
}

// Runs a recording through a servo loop; show(source, snapshot) after each cycle. 0: every cycle gave the recorded bits;
// or, where poses are enough, the file is whole.
template <typename Show>
int replay(const std::string &path, bool poses_are_enough, Show &&show) {
    auto made = std::make_unique<Replay>();
    const Replay &source = *made;
    std::string problem = made->load(path);
    if (!problem.empty()) {
        return complain(problem);
    }
    const ServoSettings settings = made->settings();
    ServoLoop loop(std::move(made));
    const Status status = loop.start_stepped(settings);
    if (!usable(status)) {
        return complain(describe(status));
    }
    // One cycle a call: exact, since the carry of the loop counts in thousandths of a hertz.
    const double millihertz = 1000.0 * settings.rate_hz;
    const auto denominator = static_cast<std::uint32_t>(millihertz + 0.5);
    while (!source.report().finished) {
        loop.advance(1000, denominator);
        ServoSnapshot now;
        if (loop.latest(now)) {
            show(source, now);
        }
    }
    const ReplayReport report = source.report();
    const std::string damage = source.damage();
    loop.stop();
    std::fprintf(stderr, "%llu cycles replayed, %llu with other bits", whole(report.cycles),
                 whole(report.differing));
    if (report.differing != 0) {
        std::fprintf(stderr, " (the first is cycle %llu)", whole(report.first_differing));
    }
    std::fprintf(stderr, ", %llu missing\n", whole(report.lost));
    if (!damage.empty()) {
        return complain(damage);
    }
    if (!source.why_poses_only().empty()) {
        complain(source.why_poses_only());
        return poses_are_enough ? 0 : kWrong;
    }
    return report.differing == 0 && report.lost == 0 && report.cycles > 0 ? 0 : kWrong;
}

int csv(const std::string &path) {
    RecordingReader reader;
    const std::string problem = reader.open(path);
    if (!problem.empty()) {
        return complain(problem);
    }
    const StringCalibration strings = reader.info().settings.strings;
    print_head();
    return replay(path, true, [&](const Replay &source, const ServoSnapshot &now) {
        print_recorded(source.cycle(), strings);
        print_replayed(now, source.why_poses_only().empty());
        std::printf("\n");
    });
}

} // namespace

int main(int argc, char **argv) {
    constexpr int kArguments = 3;
    if (argc != kArguments) {
        return usage();
    }
    const std::string path = argv[2];
    if (std::strcmp(argv[1], "info") == 0) {
        return info(path);
    }
    if (std::strcmp(argv[1], "csv") == 0) {
        return csv(path);
    }
    if (std::strcmp(argv[1], "verify") == 0) {
        return replay(path, false, [](const Replay &, const ServoSnapshot &) {});
    }
    return usage();
}
