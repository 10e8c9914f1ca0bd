#include "device/recording/replay_transport.h"

#include <cstring>
#include <new>

#include "device/recording/codec/command_fields.h"
#include "device/step/servo_step.h"

namespace spidar {

std::string ReplayTransport::load(const std::string &path) {
    std::string problem = reader_.open(path);
    return problem.empty() ? why_no_replay(reader_.info()) : problem;
}

Status ReplayTransport::open() noexcept {
    if (is_open_) {
        return Status::ok;
    }
    level_before_ = simd_level();
    if (!set_simd_level(reader_.info().simd)) {
        return Status::open_failed;
    }
    is_open_ = true;
    return Status::ok;
}

void ReplayTransport::close() noexcept {
    if (is_open_) {
        set_simd_level(level_before_);
        is_open_ = false;
    }
}

bool ReplayTransport::next(ServoStep &step, HapticCommand &command, double &dt_s) noexcept {
    bool more = false;
    try {
        more = !finished_.load(std::memory_order_relaxed) && reader_.next(cycle_);
    } catch (const std::bad_alloc &) { // no memory for the next chunk: as good as the end
        more = false;
    }
    const std::size_t memory_bytes = reader_.memory().size();
    more = more && (!cycle_.segment_start || memory_bytes == sizeof step);
    lost_.store(reader_.lost(), std::memory_order_relaxed);
    if (!more) {
        finished_.store(true, std::memory_order_release);
        return false;
    }
    if (cycle_.segment_start) {
        // Of this build (why_no_replay), trivially copyable (recorder.cpp), and whole by its checksum.
        std::memcpy(static_cast<void *>(&step), reader_.memory().data(), sizeof step);
    }
    if (cycle_.command_is_new) {
        load_words(cycle_.command_words, command);
    }
    dt_s = cycle_.input.dt_s;
    return true;
}

Status ReplayTransport::read(DeviceReading &reading) noexcept {
    reading = cycle_.input.reading;
    return cycle_.input.read_status;
}

Status ReplayTransport::write(const DriveCommand & /*command*/) noexcept {
    return cycle_.input.write_status;
}

void ReplayTransport::compare(const ServoSnapshot &snapshot, const DriveCommand &drive) noexcept {
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

ReplayReport ReplayTransport::report() const noexcept {
    ReplayReport report;
    report.finished = finished_.load(std::memory_order_acquire);
    report.cycles = cycles_.load(std::memory_order_relaxed);
    report.differing = differing_.load(std::memory_order_relaxed);
    report.first_differing = first_differing_.load(std::memory_order_relaxed);
    report.lost = lost_.load(std::memory_order_relaxed);
    report.time_s = time_s_.load(std::memory_order_relaxed);
    return report;
}

std::string ReplayTransport::damage() const {
    return finished_.load(std::memory_order_acquire) ? reader_.damage() : std::string();
}

} // namespace spidar
