// The recording that a loop makes, and those that were stopped while the loop's thread may still hold them.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "device/recording/recorder.h"

namespace spidar {

class Recordings {
public:
    // From the controlling thread. in_time: the loop runs in a thread of its own. touches: scenes that the loop may still
    // look at. Empty: recording. Else one sentence.
    [[nodiscard]] std::string start(const std::string &path, const ServoSettings &settings,
                                    bool in_time, const std::deque<NumberedTouch> &touches) {
        if (recording()) {
            return "A recording runs already. Stop it before the next one starts.";
        }
        const std::uint64_t done = cycles_.load(std::memory_order_acquire);
        std::erase_if(owned_, [done, in_time](const Owned &owned) {
            return !in_time || done >= owned.free_at_cycle;
        });
        auto recorder = std::make_unique<Recorder>(settings, in_time);
        std::string problem = recorder->open(path);
        if (problem.empty()) {
            for (const NumberedTouch &touch : touches) {
                recorder->note(touch);
            }
            owned_.push_back({std::move(recorder)});
            current_.store(owned_.back().recorder.get(), std::memory_order_release);
        }
        return problem;
    }
    void stop() noexcept {
        Recorder *const recorder = current_.exchange(nullptr, std::memory_order_acq_rel);
        if (recorder == nullptr) {
            return;
        }
        // The cycle that runs now may hold it, and the one that is about to begin has not seen the change.
        constexpr std::uint64_t kCyclesToLetGo = 2;
        owned_.back().free_at_cycle = cycles_.load(std::memory_order_acquire) + kCyclesToLetGo;
        recorder->close();
        last_ = recorder->statistics();
    }
    // The same, while the loop rests: nothing holds a recorder.
    void stop_at_rest() noexcept {
        stop();
        owned_.clear();
    }
    [[nodiscard]] bool recording() const noexcept {
        return current_.load(std::memory_order_relaxed) != nullptr;
    }
    // Of the recording that runs, or else of the last one.
    [[nodiscard]] RecorderStatistics statistics() const noexcept {
        const Recorder *const recorder = current_.load(std::memory_order_relaxed);
        return recorder != nullptr ? recorder->statistics() : last_;
    }

    // From the controlling thread: what the game has just read.
    void note(const GameRead &read) noexcept {
        if (Recorder *const recorder = current_.load(std::memory_order_relaxed)) {
            recorder->note(read);
        }
    }

    // The same: a scene, before its command is published.
    void note(const NumberedTouch &touch) {
        if (Recorder *const recorder = current_.load(std::memory_order_relaxed)) {
            recorder->note(touch);
        }
    }

    // From the loop's thread: what this cycle is recorded by, null for nothing; and the end of a cycle.
    [[nodiscard]] Recorder *current() const noexcept {
        return current_.load(std::memory_order_acquire);
    }
    void end_cycle() noexcept {
        cycles_.store(cycles_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

private:
    // The one that records now is the last.
    struct Owned {
        std::unique_ptr<Recorder> recorder;
        std::uint64_t free_at_cycle = UINT64_MAX; // from then on the loop has let go of it
    };
    std::vector<Owned> owned_;
    std::atomic<Recorder *> current_{nullptr};
    std::atomic<std::uint64_t> cycles_{0};
    RecorderStatistics last_;
};

} // namespace spidar
