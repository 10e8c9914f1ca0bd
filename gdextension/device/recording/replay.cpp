#include "device/recording/replay.h"

#include <cstring>
#include <new>
#include <sstream>

#include "core/base/simd_level.h"
#include "core/base/sound_state.h"
#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/touch_words.h"
#include "device/step/servo_step.h"

namespace spidar {

std::string Replay::load(const std::string &path) {
    std::string problem = reader_.open(path);
    if (problem.empty()) {
        problem = reads_.open(path);
    }
    return problem.empty() ? prepare() : problem;
}

std::string Replay::load(const std::string &bytes, const std::string &name) {
    std::string problem = reader_.open(std::make_unique<std::istringstream>(bytes), name);
    if (problem.empty()) {
        problem = reads_.open(std::make_unique<std::istringstream>(bytes), name);
    }
    return problem.empty() ? prepare() : problem;
}

std::string Replay::prepare() {
    why_poses_only_ = why_no_replay(reader_.info());
    shapes_.clear();
    reader_.keep_shapes(why_poses_only_.empty() ? &shapes_ : nullptr);
    settings_ = reader_.info().settings;
    if (!supports(settings_.tension.simd)) {
        settings_.tension.simd = best_simd_level();
    }
    const std::string problem = validate(settings_);
    return problem.empty() ? problem
                           : "The recording holds settings that this version of spidar_g cannot "
                             "use: " +
                                 problem;
}

bool Replay::next_read(GameRead &read) noexcept {
    try {
        return reads_.next(read);
    } catch (const std::bad_alloc &) { // no memory for the next chunk: as good as the end
        return false;
    }
}

bool Replay::fetch() noexcept {
    if (fetched_) {
        return true;
    }
    try {
        fetched_ = !finished_.load(std::memory_order_relaxed) && reader_.next(cycle_);
    } catch (const std::bad_alloc &) { // no memory for the next chunk: as good as the end
        fetched_ = false;
    }
    return fetched_;
}

bool Replay::restore(ServoStep &step) noexcept {
    const std::span<const std::uint8_t> memory = reader_.memory();
    bool sound = memory.size() == sizeof step;
    if (sound) {
        ServoStep found; // same build (why_no_replay), trivially copyable (recorder.cpp)
        std::memcpy(static_cast<void *>(&found), memory.data(), sizeof found);
        // The step counts the cycles as the file does.
        sound = found.is_sound() && found.snapshot().counters.ticks + 1 == cycle_.tick &&
                found.touch().relink(
                    step.touch().memory(),
                    [this](std::uint64_t number) { return shapes_.shape(number); },
                    [this](std::uint64_t number) { return shapes_.tool(number); });
        if (sound) {
            step = found;
            step.touch().forget_pairs();
        }
    }
    unsound_.store(!sound, std::memory_order_relaxed);
    return sound;
}

bool Replay::recall(ServoStep &step) noexcept {
    return why_poses_only_.empty() && fetch() && cycle_.segment_start && restore(step);
}

bool Replay::next(CycleGiven &given, ServoStep &step, EventLog & /*events*/) noexcept {
    const bool exact = why_poses_only_.empty();
    // The first cycle of an exact replay needs a memory before it.
    const bool starts = cycles_.load(std::memory_order_relaxed) == 0;
    bool more = fetch();
    if (more && exact && (starts || cycle_.segment_start)) {
        more = cycle_.segment_start && restore(step);
    }
    lost_.store(reader_.lost(), std::memory_order_relaxed);
    if (!more) {
        finished_.store(true, std::memory_order_release);
        return false;
    }
    fetched_ = false;
    if (exact && cycle_.command_is_new) {
        load_words(cycle_.command_words, given.command);
        contacts_sequence_ = given.command.contacts_sequence;
        if (cycle_.touch_is_new) {
            given.command.touch =
                load_touch(reader_.touch_words(), shapes_, touch_) ? &touch_ : nullptr;
        }
    }
    given.command_is_new = true; // for a recording of the replay
    given.input = cycle_.input;
    return true;
}

const ServoSnapshot *Replay::shown(const ServoSnapshot &snapshot) noexcept {
    if (why_poses_only_.empty()) {
        return nullptr;
    }
    constexpr double kNewton = 1e-3; // from mN
    shown_ = snapshot;
    shown_.counters.ticks = cycle_.tick;
    shown_.state =
        is_one_of(cycle_.state, DeviceState::calibrated) ? cycle_.state : DeviceState::connected;
    shown_.grasp =
        is_one_of(cycle_.grasp, GraspPhase::over_closed) ? cycle_.grasp : GraspPhase::open;
    shown_.fault = cycle_.fault;
    shown_.fault_string =
        is_string_or_none(cycle_.fault_string) ? cycle_.fault_string : std::int8_t{-1};
    shown_.tension_status = cycle_.tension_status;
    for (std::size_t i = 0; i < shown_.tensions_n.size(); ++i) {
        shown_.tensions_n[i] = kNewton * cycle_.tensions_mn[i];
    }
    return &shown_;
}

Status Replay::write(const DriveCommand & /*drive*/) noexcept {
    return cycle_.input.write_status;
}

void Replay::finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                    double /*dt_s*/) noexcept {
    cycles_.fetch_add(1, std::memory_order_relaxed);
    time_s_.store(snapshot.time_s, std::memory_order_relaxed);
    if (!why_poses_only_.empty()) {
        return;
    }
    CycleOutput output;
    fill_output(snapshot, drive, output);
    if (digest_of(output) != cycle_.digest) {
        if (differing_.fetch_add(1, std::memory_order_relaxed) == 0) {
            first_differing_.store(cycle_.tick, std::memory_order_relaxed);
        }
    }
}

ReplayReport Replay::report() const noexcept {
    ReplayReport report;
    report.finished = finished_.load(std::memory_order_acquire);
    report.cycles = cycles_.load(std::memory_order_relaxed);
    report.differing = differing_.load(std::memory_order_relaxed);
    report.first_differing = first_differing_.load(std::memory_order_relaxed);
    report.lost = lost_.load(std::memory_order_relaxed);
    report.time_s = time_s_.load(std::memory_order_relaxed);
    return report;
}

std::string Replay::damage() const {
    if (!finished_.load(std::memory_order_acquire)) {
        return {};
    }
    return unsound_.load(std::memory_order_relaxed)
               ? "The recording holds a memory state that no servo step can have. It is damaged or "
                 "was changed, so it is not replayed beyond this place."
               : reader_.damage();
}

} // namespace spidar
