// Recordings to test with: a simulated device that is touched, pushed, unplugged and plugged in again.
#pragma once

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "device/recording/codec/command_fields.h"
#include "device/recording/recorder.h"
#include "device/recording/replay.h"
#include "support/servo_fixture.h"
#include "support/snapshot_bits.h"

namespace spidar::test {

// A file of its own, gone at the end.
class TemporaryFile {
public:
    TemporaryFile() {
        static std::atomic<int> number{0};
        path_ = (std::filesystem::temp_directory_path() /
                 ("spidar_test_" + std::to_string(reinterpret_cast<std::uintptr_t>(&number)) + "_" +
                  std::to_string(monotonic_number()) + "_" + std::to_string(number++) + ".rec"))
                    .string();
    }
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;
    [[nodiscard]] const std::string &path() const { return path_; }
    [[nodiscard]] std::string contents() const {
        std::ifstream file(path_, std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        return text.str();
    }

private:
    static long long monotonic_number() {
        return std::chrono::steady_clock::now().time_since_epoch().count();
    }
    std::string path_;
};

// A stepped loop with a hand that taps a floor, and faults when asked for.
class Session {
public:
    Session() {
        auto made = std::make_unique<SimulatedTransport>(PlantSettings{});
        device = made.get();
        settings = ideal_settings();
        settings.strings = calibrate_at_home(
            string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
            made->home_counts(), kPaperMetresPerCount);
        settings.safety.arming_time_s = 0.05;
        loop = std::make_unique<ServoLoop>(std::move(made));
        command.forces_enabled = true;
        loop->publish(command);
    }

    // One game frame of 1/60 s: new contacts, a wrench now and then, the hand moved. Leaves the bits of every cycle.
    void frame() {
        ++frames;
        command.contact_count = 1;
        command.contacts[0].offset_m = -0.01 + 0.002 * (frames % 3);
        ++command.contacts_sequence;
        if (frames % 4 == 0) {
            command.wrench.force_n = Vec3(0.1 * (frames % 7), 0.0, 0.3);
            command.wrench_duration_s = 0.05;
            ++command.wrench_sequence;
        }
        if (scene) {
            loop->publish(command, scene(frames));
        } else {
            loop->publish(command);
        }
        HandTarget target;
        target.position_m = Vec3(0.0, frames % 20 < 10 ? -0.03 : 0.02, 0.001 * (frames % 11));
        target.grasp_angle_rad = 0.02 * (frames % 30);
        device->set_hand_target(target);
        for (int cycle = 0; cycle < 16; ++cycle) {
            loop->advance(1, 1000);
            ServoSnapshot now;
            REQUIRE(loop->latest(now));
            bits.push_back(bits_of(now));
            last = now;
        }
    }
    void frames_of(int count) {
        for (int i = 0; i < count; ++i) {
            frame();
        }
    }
    void unplug_for(double seconds) {
        device->inject({SimulatedFault::unplugged, 0, 0.0, seconds});
    }
    void clear_and_arm() {
        ++command.clear_fault_count;
        ++command.arm_count;
    }

    SimulatedTransport *device = nullptr;
    ServoSettings settings;
    std::unique_ptr<ServoLoop> loop;
    HapticCommand command;
    std::function<std::shared_ptr<const TouchScene>(int)>
        scene; // of a frame; unset: none is published
    int frames = 0;
    std::vector<std::uint64_t> bits;
    ServoSnapshot last;
};

// The rest of the cycles of one file into another, as they are but for what `change` does to each; a memory before each
// segment where `memories`. touch: the scene that every command points to.
template <typename Change>
void copy_cycles(RecordingReader &reader, RecordingWriter &writer, bool memories,
                 const TouchScene *touch, Change &&change) {
    RecordedCycle cycle;
    HapticCommand command;
    command.touch = touch;
    while (reader.next(cycle)) {
        if (memories && cycle.segment_start) {
            writer.memory(reader.memory());
        }
        load_words(cycle.command_words, command);
        CycleRecord record;
        record.input = cycle.input;
        record.tick = cycle.tick;
        record.segment_start = cycle.segment_start;
        record.command_is_new = cycle.command_is_new;
        change(record);
        writer.cycle(record, command);
    }
}

struct Replayed {
    std::string problem; // it did not even start
    std::vector<std::uint64_t> bits;
    ReplayReport report;
    std::string damage;
};

inline Replayed replay(const std::string &path) {
    Replayed result;
    auto made = std::make_unique<Replay>();
    const Replay &source = *made;
    result.problem = made->load(path);
    if (!result.problem.empty()) {
        return result;
    }
    const ServoSettings settings = made->settings();
    ServoLoop loop(std::move(made));
    if (!usable(loop.start_stepped(settings))) {
        result.problem = "the loop does not start";
        return result;
    }
    while (!source.report().finished) {
        loop.advance(1, static_cast<std::uint32_t>(settings.rate_hz));
        ServoSnapshot now;
        if (loop.latest(now)) {
            result.bits.push_back(bits_of(now));
        }
    }
    result.report = source.report();
    result.damage = source.damage();
    return result;
}

} // namespace spidar::test
