// Writes the cycles of a servo loop to a file without delaying the loop. The loop copies each cycle
// into a ring; a writing thread (or, in stepped time, the loop's caller) encodes and writes it. A
// cycle that finds the ring full is lost. A segment is a run of cycles without loss: it starts with
// the stored memory of the servo step.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "device/contact/touch/touch_scene.h"
#include "device/recording/recording_file.h"
#include "device/threads/spsc_ring.h"

namespace spidar {

class ServoStep;

// Time whose cycles fit in the ring (unit: s): a longer pause of the disk loses cycles.
inline constexpr double kRingTime_s = 4.0;

// Progress of a recording.
struct RecorderStatistics {
    std::uint64_t cycles = 0; // cycles copied into the ring
    std::uint64_t lost = 0;   // cycles lost because the ring was full; marked in the file
    std::uint64_t bytes = 0;  // bytes written
    bool failed = false;      // a write failed and nothing more is written
};

// A scene that a game published (or null), with the touch_sequence of its command.
struct NumberedTouch {
    std::uint64_t sequence = 0;
    std::shared_ptr<const TouchScene> touch;
};

class Recorder {
public:
    // in_time: the loop runs in its own thread, and a writing thread empties the ring. Otherwise
    // end() empties it.
    Recorder(const ServoSettings &settings, bool in_time);
    ~Recorder(); // calls close()
    Recorder(const Recorder &) = delete;
    Recorder &operator=(const Recorder &) = delete;

    // Opens the file; called from the controlling thread. Returns an empty string, or a text with
    // the reason of a failure.
    [[nodiscard]] std::string open(const std::string &path);
    // Writes what the ring holds and closes the file; called from the controlling thread. The loop
    // may still call begin() and end(), which then have no effect.
    void close() noexcept;

    // begin() and end() enclose each step in the loop's thread. If in_time, they neither wait nor
    // allocate. `step` is the state before the cycle. At the start of a segment, begin() clears the
    // step's memory of shape pairs, as a replay does.
    void begin(const ServoStep &step) noexcept;
    void end(CycleInput input, const DriveCommand &drive, const ServoSnapshot &snapshot,
             const HapticCommand &command, bool command_is_new) noexcept;
    // Records that the game has just read a snapshot. Called from the controlling thread; does not
    // wait.
    void note(const GameRead &read) noexcept;
    // Records a scene. Called from the controlling thread before the scene's command is published.
    // When a recording starts, all scenes that the loop may still use must be noted first, oldest
    // first. The scene and its shapes are kept alive until they are written.
    void note(NumberedTouch touch);

    [[nodiscard]] RecorderStatistics statistics() const noexcept;

private:
    void drain();
    void take_touches();
    const TouchScene *touch_of(std::uint64_t sequence);
    void mark_lost(std::uint64_t lost);
    void write_in_time();

    const RecordingInfo info_;
    const bool in_time_;

    // Used by the loop.
    SpscRing<CycleRecord> cycles_;
    SpscRing<HapticCommand> commands_;
    // Filled by the controlling thread.
    SpscRing<GameRead> reads_;
    bool segment_needed_ = true;   // the next cycle starts a segment
    bool segment_started_ = false; // the memory of that segment is stored
    bool command_missing_ = false; // a lost cycle had a new command
    std::atomic<std::uint64_t> handed_over_{0};
    std::atomic<std::uint64_t> lost_{0};

    // The memory of the step at the start of a segment. Owned by the loop while memory_full_ is
    // false, else by the writer.
    std::vector<std::uint8_t> memory_;
    std::atomic<bool> memory_full_{false};

    // Used by the writer.
    RecordingWriter file_;
    HapticCommand command_;
    // Scenes that a command may still refer to: first the one of the newest command written, then
    // all later ones.
    std::deque<NumberedTouch> touches_;
    // Numbers of the shapes that were written to the file.
    std::set<std::uint64_t> shapes_kept_;
    std::uint64_t lost_marked_ = 0;
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<bool> failed_{false};

    bool is_open_ = false; // used by the controlling thread
    std::thread thread_;
    // Guards the members below. The loop never uses it.
    std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_asked_ = false;
    // Scenes that the writer has not taken yet.
    std::deque<NumberedTouch> noted_;
};

} // namespace spidar
