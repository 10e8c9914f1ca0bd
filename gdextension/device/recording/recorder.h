// Writes every cycle of a servo loop to a file without holding the loop up: the loop puts a plain copy into a ring, and
// a thread of its own (or, in stepped time, the loop's caller) makes bytes of it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

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

    // From the loop's thread, around each step, without waiting or allocating. step: before it takes this cycle.
    void begin(const ServoStep &step) noexcept;
    void end(CycleInput input, const DriveCommand &drive, const ServoSnapshot &snapshot,
             const HapticCommand &command, bool command_is_new) noexcept;
    // From the controlling thread, without waiting: what the game has just read.
    void note(const GameRead &read) noexcept;

    [[nodiscard]] RecorderStatistics statistics() const noexcept;

private:
    void drain();
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
    std::uint64_t lost_marked_ = 0;
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<bool> failed_{false};

    bool is_open_ = false; // the controlling thread's
    std::thread thread_;
    std::mutex mutex_; // of stop_asked_; the loop has no part in it
    std::condition_variable wake_;
    bool stop_asked_ = false;
};

} // namespace spidar
