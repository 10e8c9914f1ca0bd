#include "device/loop/recordings.h"

namespace spidar {

std::string Recordings::start(const std::string &path, const ServoSettings &settings,
                              bool in_time) {
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
        owned_.push_back({std::move(recorder)});
        current_.store(owned_.back().recorder.get(), std::memory_order_release);
    }
    return problem;
}

void Recordings::stop() noexcept {
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

void Recordings::stop_at_rest() noexcept {
    stop();
    owned_.clear();
}

RecorderStatistics Recordings::statistics() const noexcept {
    const Recorder *const recorder = current_.load(std::memory_order_relaxed);
    return recorder != nullptr ? recorder->statistics() : last_;
}

} // namespace spidar
