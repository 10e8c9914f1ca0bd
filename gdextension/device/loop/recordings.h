// The running recording of a loop, and stopped ones whose recorder the loop's thread may still use.
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
    // Starts a recording; called from the controlling thread. in_time: the loop runs in its own
    // thread. touches: scenes that the loop may still use. Returns an empty string, or one sentence
    // with the reason why nothing is recorded.
    [[nodiscard]] std::string start(const std::string &path, const ServoSettings &settings,
                                    bool in_time, const std::deque<NumberedTouch> &touches) {
        if (recording()) {
            return "A recording is already running. Stop it before the next one starts.";
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
        // The current cycle may use the recorder; the next one may not have seen the change yet.
        constexpr std::uint64_t kCyclesToLetGo = 2;
        owned_.back().free_at_cycle = cycles_.load(std::memory_order_acquire) + kCyclesToLetGo;
        recorder->close();
        last_ = recorder->statistics();
    }
    // Like stop(), but called while no cycle runs: also frees the recorders.
    void stop_at_rest() noexcept {
        stop();
        owned_.clear();
    }
    [[nodiscard]] bool recording() const noexcept {
        return current_.load(std::memory_order_relaxed) != nullptr;
    }
    // Of the running recording, else of the last one.
    [[nodiscard]] RecorderStatistics statistics() const noexcept {
        const Recorder *const recorder = current_.load(std::memory_order_relaxed);
        return recorder != nullptr ? recorder->statistics() : last_;
    }

    // Records what the game has just read. Called from the controlling thread.
    void note(const GameRead &read) noexcept {
        if (Recorder *const recorder = current_.load(std::memory_order_relaxed)) {
            recorder->note(read);
        }
    }

    // Records a scene before its command is published. Called from the controlling thread.
    void note(const NumberedTouch &touch) {
        if (Recorder *const recorder = current_.load(std::memory_order_relaxed)) {
            recorder->note(touch);
        }
    }

    // Returns the recorder of this cycle, or null. Called from the loop's thread, like end_cycle().
    [[nodiscard]] Recorder *current() const noexcept {
        return current_.load(std::memory_order_acquire);
    }
    void end_cycle() noexcept {
        cycles_.store(cycles_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

private:
    // While a recording runs, the last element of owned_ is its recorder.
    struct Owned {
        std::unique_ptr<Recorder> recorder;
        std::uint64_t free_at_cycle = UINT64_MAX; // the loop no longer uses it from this cycle on
    };
    std::vector<Owned> owned_;
    std::atomic<Recorder *> current_{nullptr};
    std::atomic<std::uint64_t> cycles_{0};
    RecorderStatistics last_;
};

} // namespace spidar
