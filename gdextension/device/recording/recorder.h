// Writes every cycle of a servo loop to a file without holding the loop up: the loop puts a plain copy into a ring, and
// a thread of its own (or, in stepped time, the loop's caller) makes bytes of it.
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

// The ring holds this much time: what a disk may sleep before cycles are lost.
inline constexpr double kRingTime_s = 4.0;

// What a recording has come to.
struct RecorderStatistics {
    std::uint64_t cycles = 0; // handed over
    std::uint64_t lost = 0;   // the ring was full; marked in the file
    std::uint64_t bytes = 0;  // written
    bool failed = false;      // the file could not be written any further
};

// A scene that a game published, or null for none, and the touch_sequence of its command.
struct NumberedTouch {
    std::uint64_t sequence = 0;
    std::shared_ptr<const TouchScene> touch;
};

class Recorder {
public:
    // in_time: the loop has a thread of its own. Then a writing thread drains the ring; else the loop's caller does, and
    // nothing is ever lost.
    Recorder(const ServoSettings &settings, bool in_time);
    ~Recorder(); // close()
    Recorder(const Recorder &) = delete;
    Recorder &operator=(const Recorder &) = delete;

    // From the controlling thread. Empty: recording. Else one sentence.
    [[nodiscard]] std::string open(const std::string &path);
    // From the controlling thread: what the ring holds is written, and the file closed. The loop may still call
    // begin() and end(); they then do nothing that lasts.
    void close() noexcept;

    // From the loop's thread, around each step, without waiting or allocating. step: before it takes this cycle. Where a
    // segment starts it forgets what it remembers of pairs of shapes, as a replay does there.
    void begin(const ServoStep &step) noexcept;
    void end(CycleInput input, const DriveCommand &drive, const ServoSnapshot &snapshot,
             const HapticCommand &command, bool command_is_new) noexcept;
    // From the controlling thread, without waiting: what the game has just read.
    void note(const GameRead &read) noexcept;
    // From the controlling thread: a scene, before its command is published; when a recording starts, all that the loop may
    // still look at, oldest first, before the loop is told of the recorder. Its shapes are kept in the file, and alive until
    // they are there.
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

    // The loop's.
    SpscRing<CycleRecord> cycles_;
    SpscRing<HapticCommand> commands_;
    SpscRing<GameRead> reads_;     // the controlling thread's
    bool segment_needed_ = true;   // the next cycle starts a segment
    bool segment_started_ = false; // its memory is stored
    bool command_missing_ = false; // a new command came in a cycle that was lost
    std::atomic<std::uint64_t> handed_over_{0};
    std::atomic<std::uint64_t> lost_{0};

    // The memory of the step at the start of a segment: the loop's while not full, then the writer's.
    std::vector<std::uint8_t> memory_;
    std::atomic<bool> memory_full_{false};

    // The writer's.
    RecordingWriter file_;
    HapticCommand command_;
    std::deque<NumberedTouch> touches_;   // from the newest on that a recorded command had
    std::set<std::uint64_t> shapes_kept_; // their numbers: the shapes are in the file
    std::uint64_t lost_marked_ = 0;
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<bool> failed_{false};

    bool is_open_ = false; // the controlling thread's
    std::thread thread_;
    std::mutex mutex_; // of what follows; the loop has no part in it
    std::condition_variable wake_;
    bool stop_asked_ = false;
    std::deque<NumberedTouch> noted_; // the writer has not taken them yet
};

} // namespace spidar
