#include "bench/bench_recording.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "bench/repeated_times.h"
#include "device/recording/recorder.h"
#include "device/step/servo_step.h"
#include "device/threads/triple_buffer.h"

namespace spidar::bench {

namespace {

constexpr int kTicks = 20000;
constexpr int kWarmUpTicks = 3000; // arming and every ramp
constexpr double kPeriod_s = 1e-3;
constexpr int kTicksPerFrame = 16;
// Ticks come far faster here than in time: the writing thread gets its share in between.
constexpr int kTicksPerRest = 500;
constexpr std::chrono::milliseconds kRest{30};
// A disk that sleeps for seconds loses cycles, which cost less: then the whole is measured again.
constexpr int kAttempts = 3;

// What the servo thread does between read and write, and for the game.
struct Loop {
    ServoStep step;
    TripleBuffer<ServoSnapshot> snapshots;
    DriveCommand drive;

    void cycle(const DeviceReading &reading, const HapticCommand &command) noexcept {
        drive = step.step(Status::ok, reading, command, kPeriod_s, true);
        snapshots.write(step.snapshot());
    }
    void recorded_cycle(const DeviceReading &reading, const HapticCommand &command,
                        bool command_is_new, Recorder &recorder) noexcept {
        recorder.begin(step);
        drive = step.step(Status::ok, reading, command, kPeriod_s, true);
        recorder.end({reading, kPeriod_s, Status::ok, Status::ok, true}, drive, step.snapshot(),
                     command, command_is_new);
        snapshots.write(step.snapshot());
    }
};

DeviceReading reading_at(const ServoSettings &settings, int tick) {
    const double t = kPeriod_s * tick;
    const Vec3 position(0.1 * std::sin(3.1 * t), 0.1 * std::sin(2.3 * t + 1.0),
                        0.1 * std::sin(2.9 * t + 2.0));
    const StringArray lengths =
        string_lengths(settings.frame, settings.grip,
                       make_pose(settings.grip, position, Mat3(1.0), 0.4 * std::sin(2.1 * t)));
    DeviceReading reading;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        reading.counts[i] = static_cast<std::int32_t>(std::lround(
            (lengths[i] - settings.strings.offset_m[i]) / settings.strings.scale_m_per_count[i]));
    }
    reading.sequence = static_cast<std::uint16_t>(tick);
    reading.device_time_us = static_cast<std::uint64_t>(tick) * 1000;
    return reading;
}

BenchRow row_of(const char *mode, const RepeatedTimes &times) {
    BenchRow row;
    row.method = "cycle";
    row.set = "recording";
    row.mode = mode;
    times.fill(row);
    return row;
}

enum class Outcome { measured, lossy, failed };

Outcome measure(std::vector<BenchRow> &rows) {
    ServoSettings settings;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          {}, kPaperMetresPerCount);
    const auto plain = std::make_unique<Loop>();
    const auto recorded = std::make_unique<Loop>();
    if (!usable(plain->step.configure(settings)) || !usable(recorded->step.configure(settings))) {
        return Outcome::failed;
    }
    const std::string path =
        (std::filesystem::temp_directory_path() /
         ("spidar_bench_" +
          std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + ".rec"))
            .string();
    Recorder recorder(settings, true);
    const std::string problem = recorder.open(path);
    if (!problem.empty()) {
        std::printf("  FAILED: %s\n", problem.c_str());
        return Outcome::failed;
    }
    print_header("a servo cycle without and with a recording: wrench, 4 contacts, moving");
    HapticCommand command;
    command.forces_enabled = true;
    command.contact_count = 4;
    for (int i = 0; i < command.contact_count; ++i) {
        ContactPlane &plane = command.contacts[static_cast<std::size_t>(i)];
        plane.normal = Vec3(std::sin(0.7 * i), std::cos(0.7 * i), 0.0);
        plane.offset_m = -0.02;
        plane.id = i;
    }
    RepeatedTimes off(kTicks);
    RepeatedTimes on(kTicks);
    for (int tick = 0; tick < kWarmUpTicks + kTicks; ++tick) {
        if (tick % kTicksPerRest == 0) {
            std::this_thread::sleep_for(kRest);
        }
        const bool frame = tick % kTicksPerFrame == 0;
        if (frame) {
            command.wrench = {Vec3(std::sin(0.01 * tick), 1.0, 0.0), Vec3(0.0, 0.02, 0.0), 0.01};
            command.wrench_duration_s = 0.1;
            ++command.wrench_sequence;
            command.contacts[0].offset_m = -0.02 + 1e-3 * std::sin(0.1 * tick);
            ++command.contacts_sequence;
        }
        const DeviceReading reading = reading_at(settings, tick);
        const auto without = [&] { plain->cycle(reading, command); };
        const auto with = [&] { recorded->recorded_cycle(reading, command, frame, recorder); };
        const auto timed = static_cast<std::size_t>(tick - kWarmUpTicks);
        if (tick < kWarmUpTicks) {
            without();
            with();
        } else if (tick % 2 == 0) { // neither always finds the other's caches
            off.time(timed, without);
            on.time(timed, with);
        } else {
            on.time(timed, with);
            off.time(timed, without);
        }
    }
    recorder.close();
    const RecorderStatistics statistics = recorder.statistics();
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    const BenchRow off_row = row_of("off", off);
    const BenchRow on_row = row_of("on", on);
    for (const BenchRow &row : {off_row, on_row}) {
        print_row(row);
    }
    std::printf("recording: %.3f times the cycle without, %.1f bytes a cycle, %llu cycles lost\n",
                on_row.median_ns / off_row.median_ns,
                static_cast<double>(statistics.bytes) / static_cast<double>(statistics.cycles),
                static_cast<unsigned long long>(statistics.lost));
    if (recorded->step.snapshot().state != DeviceState::active) {
        std::printf("  FAILED: no forces\n");
        return Outcome::failed;
    }
    if (statistics.lost != 0) {
        return Outcome::lossy;
    }
    rows.insert(rows.end(), {off_row, on_row});
    return Outcome::measured;
}

} // namespace

int bench_recording(std::vector<BenchRow> &rows) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const Outcome outcome = measure(rows);
        if (outcome != Outcome::lossy) {
            return outcome == Outcome::measured ? 0 : 1;
        }
    }
    std::printf("  FAILED: cycles were lost %d times\n", kAttempts);
    return 1;
}

} // namespace spidar::bench
