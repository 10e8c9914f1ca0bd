// Plays a recording: feeds a servo loop the recorded inputs and compares a digest of all bits of
// each cycle's outputs. No motor is driven, and no command of the present game is used.
// A recording of another build plays as poses: this build's kinematics find the poses from the
// recorded counts, and the snapshot holds the recorded state, grasp, fault and tensions, without
// wrenches and contacts. Nothing is compared.
// A file may be damaged or malicious: the memory in it is checked before it is used.
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
    std::uint64_t differing = 0;       // cycles whose output differed from the recording
    std::uint64_t first_differing = 0; // tick of the first one; 0: none
    std::uint64_t lost = 0;            // cycles missing in the recording so far
    bool finished = false;             // no cycle is left
    // Time of the last cycle.
    double time_s = 0.0;
};

class Replay final : public CycleSource {
public:
    // Loads a file. Returns an empty string, or a text with the reason: no file, damaged head,
    // unusable settings.
    [[nodiscard]] std::string load(const std::string &path);
    // Loads the bytes of a file; `name` appears in messages.
    [[nodiscard]] std::string load(const std::string &bytes, const std::string &name);
    // After load(): empty when the recording plays bit for bit, else why it plays as poses.
    [[nodiscard]] const std::string &why_poses_only() const noexcept { return why_poses_only_; }

    // Settings of the recorded device, with which the loop must be started.
    [[nodiscard]] const ServoSettings &settings() const noexcept { return settings_; }
    [[nodiscard]] const RecordingInfo &info() const noexcept { return reader_.info(); }

    Status open() noexcept override { return Status::ok; }
    void close() noexcept override {}
    [[nodiscard]] bool simulated() const noexcept override { return true; } // runs in its own time
    // Sets the step's memory to that before the first cycle. Returns false when the recording plays
    // as poses or when that memory is unusable.
    bool recall(ServoStep &step) noexcept override;
    // Gives the inputs of the next cycle. At a segment's start, sets the step's memory as recorded.
    // Returns false at the end.
    bool next(CycleGiven &given, ServoStep &step, EventLog &events) noexcept override;
    Status write(const DriveCommand &drive) noexcept override;
    // Returns the recorded state when playing as poses, else null.
    const ServoSnapshot *shown(const ServoSnapshot &snapshot) noexcept override;
    // Compares the outputs of the cycle with the recording.
    void finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                double dt_s) noexcept override;

    // Reads when the recorded game next read the device; false when there is no more. Called from
    // the controlling thread.
    [[nodiscard]] bool next_read(GameRead &read) noexcept;

    // Scene of the newest command up to the last cycle. Called from the loop's thread, or while no
    // cycle runs.
    [[nodiscard]] const TouchScene &touch() const noexcept { return touch_; }

    // Number of the contacts in the newest command up to the last cycle. Called as touch().
    [[nodiscard]] std::uint64_t contacts_sequence() const noexcept { return contacts_sequence_; }

    // The last replayed cycle, as recorded. Called as touch().
    [[nodiscard]] const RecordedCycle &cycle() const noexcept { return cycle_; }

    // Called from any thread.
    [[nodiscard]] ReplayReport report() const noexcept;
    // When finished: empty, or the reason why the recording ends early.
    [[nodiscard]] std::string damage() const;

private:
    // Decides how an opened file plays. Returns an empty string, or the problem with its settings.
    [[nodiscard]] std::string prepare();
    // Reads the next cycle. Returns false when there is none.
    bool fetch() noexcept;
    // Restores the memory of the segment at cycle_. Returns false without usable memory.
    bool restore(ServoStep &step) noexcept;

    RecordedShapes shapes_; // the step may point to these
    TouchScene touch_;      // of the newest command
    RecordingReader reader_;
    RecordingReader reads_;
    std::string why_poses_only_;
    ServoSettings settings_;
    ServoSnapshot shown_;              // when playing as poses
    std::atomic<bool> unsound_{false}; // a memory was refused
    RecordedCycle cycle_;
    bool fetched_ = false; // cycle_ was read and not replayed yet
    std::uint64_t contacts_sequence_ = 0;
    std::atomic<std::uint64_t> cycles_{0};
    std::atomic<std::uint64_t> differing_{0};
    std::atomic<std::uint64_t> first_differing_{0};
    std::atomic<std::uint64_t> lost_{0};
    std::atomic<double> time_s_{0.0};
    std::atomic<bool> finished_{false};
};

} // namespace spidar
