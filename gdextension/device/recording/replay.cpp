#include "device/recording/replay.h"

#include <cstring>
#include <new>

#include "device/recording/codec/command_fields.h"
#include "device/step/servo_step.h"

namespace spidar {

std::string Replay::load(const std::string &path) {
    std::string problem = reader_.open(path);
    if (problem.empty()) {
        problem = reads_.open(path);
    }
    return problem.empty() ? why_no_replay(reader_.info()) : problem;
}

bool Replay::next_read(GameRead &read) noexcept {
    try {
        return reads_.next(read);
    } catch (const std::bad_alloc &) { // no memory for the next chunk: as good as the end
        return false;
    }
}

Status Replay::open() noexcept {
    return supports(reader_.info().settings.tension.simd) ? Status::ok : Status::open_failed;
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

bool Replay::restore(ServoStep &step) const noexcept {
    const std::span<const std::uint8_t> memory = reader_.memory();
    if (memory.size() != sizeof step) {
        return false;
    }
    // Of this build (why_no_replay), trivially copyable (recorder.cpp), and whole by its checksum.
    std::memcpy(static_cast<void *>(&step), memory.data(), sizeof step);
    return true;
}

bool Replay::recall(ServoStep &step) noexcept {
    return fetch() && cycle_.segment_start && restore(step);
}

bool Replay::next(CycleGiven &given, ServoStep &step, EventLog & /*events*/) noexcept {
    const bool more = fetch() && (!cycle_.segment_start || restore(step));
    lost_.store(reader_.lost(), std::memory_order_relaxed);
    if (!more) {
        finished_.store(true, std::memory_order_release);
        return false;
    }
    fetched_ = false;
    if (cycle_.command_is_new) {
        load_words(cycle_.command_words, given.command);
        contacts_sequence_ = given.command.contacts_sequence;
    }
    given.command_is_new = true; // for who records the replay
    given.input = cycle_.input;
    return true;
}

Status Replay::write(const DriveCommand & /*drive*/) noexcept {
    return cycle_.input.write_status;
}

void Replay::finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                    double /*dt_s*/) noexcept {
    CycleOutput output;
    fill_output(snapshot, drive, output);
    cycles_.fetch_add(1, std::memory_order_relaxed);
    time_s_.store(snapshot.time_s, std::memory_order_relaxed);
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
    return finished_.load(std::memory_order_acquire) ? reader_.damage() : std::string();
}

} // namespace spidar
