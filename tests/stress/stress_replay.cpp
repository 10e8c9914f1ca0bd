// A recording of random commands, hands, taps and faults replays to the same bits, snapshot by snapshot.
// stress_replay --cases N --seed S [--seconds T] [--keep FILE]; a case is T s of simulated time (60). An hour is
// --cases 1 --seconds 3600. Each case replays alone with --cases 1 --seed ITS_SEED.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "device/loop/servo_loop.h"
#include "device/recording/replay.h"
#include "device/simulation/simulated_transport.h"
#include "support/snapshot_bits.h"

using namespace spidar;

namespace {

constexpr std::uint64_t kFramesPerSecond = 60;
// The limit of the format: a full-rate recording may not take more on average.
constexpr double kMostBytesPerCycle = 64.0;

struct Random {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
    Vec3 vector(double size) { return {within(size), within(size), within(size)}; }
};

struct Totals {
    std::uint64_t cycles = 0;
    std::uint64_t active = 0;
    std::uint64_t touching = 0;
    std::uint64_t faults = 0;
    std::uint64_t bytes = 0;
    double record_s = 0.0;
    double replay_s = 0.0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The next game frame: a floor that is tapped, other planes and wrenches now and then, faults and their clearing.
void play(Random &random, std::uint64_t frame, HapticCommand &command, SimulatedTransport &device) {
    command.contact_count = 1 + static_cast<int>(random.engine() % 4);
    for (int i = 0; i < command.contact_count; ++i) {
        ContactPlane &plane = command.contacts[static_cast<std::size_t>(i)];
        plane.id = i;
        if (i > 0 && random.one_in(30)) {
            plane.normal = glm::normalize(random.vector(1.0) + Vec3(0.0, 1.5, 0.0));
            plane.offset_m = -0.03 + random.within(0.02);
            plane.target = static_cast<ContactTarget>(random.engine() % 5);
            plane.friction = random.one_in(2) ? 0.3 : 0.0;
        }
    }
    command.contacts[0].offset_m = -0.01;
    ++command.contacts_sequence;
    if (random.one_in(5)) {
        command.wrench = {random.vector(2.0), random.vector(0.05), random.within(0.05)};
        command.wrench_duration_s = 0.05;
        ++command.wrench_sequence;
    }
    HandTarget target;
    const bool down = (frame / 15) % 2 == 0; // taps at 2 Hz
    target.position_m = Vec3(random.within(0.01), down ? -0.03 : 0.02, random.within(0.01));
    target.grasp_angle_rad = (frame / 90) % 2 == 0 ? 0.5 : 0.0;
    device.set_hand_target(target);
    if (random.one_in(200)) {
        FaultInjection fault;
        fault.fault = static_cast<SimulatedFault>(random.engine() % 7);
        fault.string = static_cast<int>(random.engine() % kStringCount);
        fault.duration_s = 0.005 + std::abs(random.within(0.1));
        device.inject(fault);
    }
    if (random.one_in(60)) {
        ++command.clear_fault_count;
        ++command.arm_count;
    }
    command.forces_enabled = !random.one_in(500);
}

// Empty: the same bits. Else what was wrong.
std::string run(std::uint64_t seed, std::uint64_t seconds, const std::string &path,
                Totals &totals) {
    Random random{std::mt19937_64(seed)};
    PlantSettings plant;
    plant.coulomb_friction_n = random.one_in(2) ? 0.0 : 0.05;
    plant.firmness = static_cast<HandFirmness>(random.engine() % 3);
    auto made = std::make_unique<SimulatedTransport>(plant);
    SimulatedTransport &device = *made;
    ServoSettings settings;
    settings.safety.arming_time_s = 0.1;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          made->home_counts(), kPaperMetresPerCount);
    std::vector<std::uint64_t> bits;
    const std::uint64_t cycles =
        seconds * static_cast<std::uint64_t>(settings.rate_hz); // and a frame's rest
    bits.reserve(cycles);
    auto start = std::chrono::steady_clock::now();
    {
        ServoLoop loop(std::move(made));
        if (!usable(loop.start_stepped(settings))) {
            return "the loop does not start";
        }
        std::string problem = loop.start_recording(path);
        if (!problem.empty()) {
            return problem;
        }
        HapticCommand command;
        ServoSnapshot now;
        DeviceState before = DeviceState::closed;
        for (std::uint64_t frame = 0; bits.size() < cycles; ++frame) {
            play(random, frame, command, device);
            loop.publish(command);
            const std::uint64_t end = (frame + 1) * 1000 / kFramesPerSecond;
            while (bits.size() < end) {
                loop.advance(1, 1000);
                if (!loop.latest(now)) {
                    return "a cycle published nothing";
                }
                bits.push_back(test::bits_of(now));
                totals.active += now.state == DeviceState::active ? 1 : 0;
                for (int i = 0; i < now.contact_count; ++i) {
                    totals.touching += now.contacts[static_cast<std::size_t>(i)].touching ? 1 : 0;
                }
                totals.faults += now.state != before && (now.state == DeviceState::fault ||
                                                         now.state == DeviceState::closed)
                                     ? 1
                                     : 0;
                before = now.state;
            }
        }
        loop.stop();
        const RecorderStatistics recorded = loop.recording_statistics();
        totals.cycles += recorded.cycles;
        totals.bytes += recorded.bytes;
        if (recorded.cycles != bits.size() || recorded.lost != 0 || recorded.failed) {
            return "cycles are missing in the recording";
        }
    }
    totals.record_s += seconds_since(start);
    start = std::chrono::steady_clock::now();
    auto replay = std::make_unique<Replay>();
    const Replay &source = *replay;
    std::string problem = replay->load(path);
    if (!problem.empty()) {
        return problem;
    }
    const ServoSettings recorded = replay->settings();
    ServoLoop loop(std::move(replay));
    if (!usable(loop.start_stepped(recorded))) {
        return "the replay does not start";
    }
    ServoSnapshot now;
    for (std::uint64_t i = 0; i < bits.size(); ++i) {
        loop.advance(1, 1000);
        if (!loop.latest(now)) {
            return "the replay ends after " + std::to_string(i) + " cycles";
        }
        if (test::bits_of(now) != bits[i]) {
            return "other bits in cycle " + std::to_string(i + 1);
        }
    }
    loop.advance(1, 1000); // finds the end
    const ReplayReport report = source.report();
    totals.replay_s += seconds_since(start);
    if (!report.finished || report.differing != 0 || report.cycles != bits.size()) {
        return "the replay counts otherwise";
    }
    return source.damage();
}

} // namespace

int main(int argc, char **argv) {
    std::uint64_t cases = 1;
    std::uint64_t seed = 1;
    std::uint64_t seconds = 60;
    std::string keep;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::uint64_t value = std::strtoull(argv[i + 1], nullptr, 10);
        if (std::strcmp(argv[i], "--cases") == 0) {
            cases = value;
        } else if (std::strcmp(argv[i], "--seed") == 0) {
            seed = value;
        } else if (std::strcmp(argv[i], "--seconds") == 0) {
            seconds = value;
        } else if (std::strcmp(argv[i], "--keep") == 0) {
            keep = argv[i + 1];
        } else {
            std::fprintf(stderr, "usage: stress_replay [--cases N] [--seed S] [--seconds T] "
                                 "[--keep FILE]\n");
            return 2;
        }
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    const std::string path = keep.empty()
                                 ? (std::filesystem::temp_directory_path() /
                                    ("spidar_stress_replay_" + std::to_string(now) + ".rec"))
                                       .string()
                                 : keep;
    Totals totals;
    std::uint64_t failures = 0;
    for (std::uint64_t i = 0; i < cases; ++i) {
        const std::string problem = run(seed + i, seconds, path, totals);
        if (!problem.empty()) {
            ++failures;
            std::printf("FAILED: %s; replay: --cases 1 --seed %llu --seconds %llu\n",
                        problem.c_str(), static_cast<unsigned long long>(seed + i),
                        static_cast<unsigned long long>(seconds));
        }
    }
    if (keep.empty()) {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    const double bytes_per_cycle =
        totals.cycles > 0 ? static_cast<double>(totals.bytes) / static_cast<double>(totals.cycles)
                          : 0.0;
    const auto whole = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("%llu cycles recorded (%llu active, %llu contacts touching, %llu faults), %.1f "
                "bytes a cycle; simulated in %.1f s, replayed in %.1f s\n",
                whole(totals.cycles), whole(totals.active), whole(totals.touching),
                whole(totals.faults), bytes_per_cycle, totals.record_s, totals.replay_s);
    std::printf("%llu passed, %llu failed\n", whole(cases - failures), whole(failures));
    // A run without forces, touches or faults, or of too many bytes, has shown nothing.
    const bool shown = totals.active > 0 && totals.touching > 0 && totals.faults > 0 &&
                       bytes_per_cycle <= kMostBytesPerCycle;
    return failures == 0 && shown ? 0 : 1;
}
