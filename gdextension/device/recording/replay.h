// A recording that is played again: gives a servo loop what the recorded one was given, and compares what comes out with
// what came out then, bit for bit. No motor is behind it, and no game's command comes between.
// A recording of another build plays as poses: the kinematics of this build find them from the recorded counts, and the
// snapshot holds the recorded state, grasp, fault and tensions. Wrenches and contacts are zero then, and nothing is compared.
// Any file may be played, one that was made to do harm too.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "device/contact/touch/touch_scene.h"
#include "device/recording/recording_file.h"
#include "device/step/cycle_source.h"

namespace spidar {

struct ReplayReport {
    std::uint64_t cycles = 0;          // replayed so far
    std::uint64_t differing = 0;       // gave other bits than in the recording
    std::uint64_t first_differing = 0; // its tick; 0: none
    std::uint64_t lost = 0;            // missing in the recording
    bool finished = false;             // nothing more to replay
    // The last cycle's time, and what was recorded of it.
    double time_s = 0.0;
};

class Replay final : public CycleSource {
public:
    // Empty: ready for ServoLoop. Else one sentence: no file, damaged, settings that this build cannot use.
    [[nodiscard]] std::string load(const std::string &path);
    // The same for a file's bytes from anywhere; `name` stands in messages.
    [[nodiscard]] std::string load(const std::string &bytes, const std::string &name);
    // Once loaded. Empty: plays to the bit. Else it plays as poses, and this is the reason.
    [[nodiscard]] const std::string &why_poses_only() const noexcept { return why_poses_only_; }

    // Those of the recorded device: what to start the loop with.
    [[nodiscard]] const ServoSettings &settings() const noexcept { return settings_; }
    [[nodiscard]] const RecordingInfo &info() const noexcept { return reader_.info(); }

    Status open() noexcept override { return Status::ok; }
    void close() noexcept override {}
    [[nodiscard]] bool simulated() const noexcept override { return true; } // keeps its own time
    // The memory before the first cycle.
    bool recall(ServoStep &step) noexcept override;
    // At the start of a segment the step gets the memory that it had. False: the recording is at its end.
    bool next(CycleGiven &given, ServoStep &step, EventLog &events) noexcept override;
    Status write(const DriveCommand &drive) noexcept override;
    // The recorded state, where it plays as poses.
    const ServoSnapshot *shown(const ServoSnapshot &snapshot) noexcept override;
    // Compares.
    void finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                double dt_s) noexcept override;

    // From the controlling thread: what the recorded game read next. False: nothing more.
    [[nodiscard]] bool next_read(GameRead &read) noexcept;

    // The scene of shapes that the newest command of the last cycle had. From the loop's thread, or when it rests.
    [[nodiscard]] const TouchScene &touch() const noexcept { return touch_; }

    // The set of contacts that the last cycle rendered. From the loop's thread, or when it rests.
    [[nodiscard]] std::uint64_t contacts_sequence() const noexcept { return contacts_sequence_; }

    // The cycle that was last replayed, as recorded. From the loop's thread, or when it rests.
    [[nodiscard]] const RecordedCycle &cycle() const noexcept { return cycle_; }

    // From any thread.
    [[nodiscard]] ReplayReport report() const noexcept;
    // When finished: empty, or why the recording ends before its time.
    [[nodiscard]] std::string damage() const;

private:
    // Of a file that is open: how it plays.
    [[nodiscard]] std::string prepare();
    // The next cycle; false: none is left.
    bool fetch() noexcept;
    // Of the segment that cycle_ starts. False: there is no memory that a step can use.
    bool restore(ServoStep &step) noexcept;

    RecordedShapes shapes_; // that the step may point to
    TouchScene touch_;      // of the newest command
    RecordingReader reader_;
    RecordingReader reads_;
    std::string why_poses_only_;
    ServoSettings settings_;
    ServoSnapshot shown_;              // where it plays as poses
    std::atomic<bool> unsound_{false}; // a memory was refused
    RecordedCycle cycle_;
    bool fetched_ = false; // cycle_ is still to be replayed
    std::uint64_t contacts_sequence_ = 0;
    std::atomic<std::uint64_t> cycles_{0};
    std::atomic<std::uint64_t> differing_{0};
    std::atomic<std::uint64_t> first_differing_{0};
    std::atomic<std::uint64_t> lost_{0};
    std::atomic<double> time_s_{0.0};
    std::atomic<bool> finished_{false};
};

} // namespace spidar
