#include "device/recording/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <system_error>
#include <type_traits>

#include "device/step/servo_step.h"

namespace spidar {

namespace {

// The memory of a step is stored and restored byte for byte, so that it must not own anything
// outside itself.
static_assert(std::is_trivially_copyable_v<ServoStep>);

// Interval of the writing thread, and the number of intervals after which data goes to the system.
constexpr std::chrono::milliseconds kLook{20};
constexpr int kLooksPerFlush = 10;
// In stepped time the ring is emptied when this many cycles wait.
constexpr std::size_t kInlineBatch = 256;
// Commands change at most once a game frame.
constexpr double kCommandsPerCycle = 0.25;
// A game reads a cycle once, and again only in a physics tick before the next cycle. No read is
// therefore lost while no cycle is.
constexpr double kReadsPerCycle = 2.0;
// A segment restarts only when the ring has room to continue: otherwise a slow disk would get
// single cycles.
constexpr std::size_t kRestartPart = 2;

// Prefetches the place of the next record, last used a ring's length ago, while the step computes:
// end() then does not wait for memory.
void fetch_for_writing(CycleRecord *record) noexcept {
    if (record != nullptr) {
        constexpr std::size_t kCacheLine_bytes = 64;
        const char *const bytes = reinterpret_cast<const char *>(record);
        for (std::size_t i = 0; i < sizeof(CycleRecord); i += kCacheLine_bytes) {
            __builtin_prefetch(bytes + i, 1);
        }
    }
}

std::size_t ring_size(double rate_hz) {
    return static_cast<std::size_t>(std::ceil(kRingTime_s * rate_hz));
}

} // namespace

Recorder::Recorder(const ServoSettings &settings, bool in_time)
    : info_(describe_recording(settings)), in_time_(in_time), cycles_(ring_size(settings.rate_hz)),
      commands_(ring_size(kCommandsPerCycle * settings.rate_hz)),
      reads_(ring_size(kReadsPerCycle * settings.rate_hz)), memory_(sizeof(ServoStep)) {}

Recorder::~Recorder() {
    close();
}

std::string Recorder::open(const std::string &path) {
    std::string problem = file_.open(path, info_);
    if (!problem.empty()) {
        return problem;
    }
    is_open_ = true;
    bytes_.store(file_.bytes(), std::memory_order_relaxed);
    if (in_time_) {
        try {
            thread_ = std::thread([this] { write_in_time(); });
        } catch (const std::system_error &) {
            close();
            return "The recording did not start, because the system cannot start another thread.";
        }
    }
    return problem;
}

void Recorder::close() noexcept {
    if (!is_open_) {
        return;
    }
    is_open_ = false;
    if (thread_.joinable()) {
        {
            const std::lock_guard lock(mutex_);
            stop_asked_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }
    drain();
    take_touches(); // also releases the scenes
    touches_.clear();
    mark_lost(lost_.load(std::memory_order_relaxed));
    file_.close();
    bytes_.store(file_.bytes(), std::memory_order_relaxed);
    failed_.store(!file_.good(), std::memory_order_relaxed);
}

void Recorder::begin(const ServoStep &step) noexcept {
    if (!segment_needed_) {
        fetch_for_writing(cycles_.free_slot());
        return;
    }
    segment_started_ = !memory_full_.load(std::memory_order_acquire) &&
                       cycles_.size() * kRestartPart <= cycles_.capacity() &&
                       commands_.size() * kRestartPart <= commands_.capacity();
    if (segment_started_) {
        std::memcpy(memory_.data(), &step, sizeof step);
        step.touch().forget_pairs();
    }
}

void Recorder::end(CycleInput input, const DriveCommand &drive, const ServoSnapshot &snapshot,
                   const HapticCommand &command, bool command_is_new) noexcept {
    const bool starts = segment_needed_ && segment_started_;
    const bool tell_command = command_is_new || command_missing_ || starts;
    CycleRecord *const record = segment_needed_ && !starts ? nullptr : cycles_.free_slot();
    HapticCommand *const place =
        record != nullptr && tell_command ? commands_.free_slot() : nullptr;
    if (record == nullptr || (tell_command && place == nullptr)) {
        lost_.fetch_add(1, std::memory_order_relaxed);
        segment_needed_ = true;
        segment_started_ = false;
        return;
    }
    if (tell_command) {
        *place = command;
        commands_.commit();
    }
    record->input = input;
    fill_output(snapshot, drive, record->output);
    record->lost_before = lost_.load(std::memory_order_relaxed);
    record->tick = snapshot.counters.ticks;
    record->segment_start = starts;
    record->command_is_new = tell_command;
    if (starts) {
        memory_full_.store(true, std::memory_order_release);
        segment_needed_ = false;
        segment_started_ = false;
    }
    command_missing_ = false;
    cycles_.commit();
    handed_over_.fetch_add(1, std::memory_order_relaxed);
    if (!in_time_ && (cycles_.size() >= kInlineBatch ||
                      commands_.size() * kRestartPart >= commands_.capacity())) {
        drain();
        file_.flush();
    }
}

void Recorder::note(const GameRead &read) noexcept {
    (void)reads_.offer(read);
}

void Recorder::note(NumberedTouch touch) {
    const std::lock_guard lock(mutex_);
    noted_.push_back(std::move(touch));
}

// A memory or a cycle that needs a scene enters the ring after the scene was noted: whoever sees it
// there finds the scene.
void Recorder::take_touches() {
    std::deque<NumberedTouch> noted;
    {
        const std::lock_guard lock(mutex_);
        noted.swap(noted_);
    }
    const auto keep = [this](const auto *shape) {
        if (shape != nullptr && shapes_kept_.insert(shape->number()).second) {
            file_.shape(*shape);
        }
    };
    for (NumberedTouch &one : noted) {
        if (one.touch != nullptr) {
            const TouchScene &touch = *one.touch;
            for (int i = 0; i < std::clamp(touch.scene.count, 0, kMaxSceneParts); ++i) {
                const ScenePart &part = touch.scene.parts[static_cast<std::size_t>(i)];
                keep(part.shape);
                keep(part.traits.texture.relief);
            }
            for (int i = 0; i < std::clamp(touch.tool.count, 0, kMaxToolParts); ++i) {
                keep(touch.tool.parts[static_cast<std::size_t>(i)].shape);
            }
        }
        touches_.push_back(std::move(one));
    }
}

// Returns null when there is no such scene. Releases older ones.
const TouchScene *Recorder::touch_of(std::uint64_t sequence) {
    const auto find = [this, sequence] {
        return std::ranges::find(touches_, sequence, &NumberedTouch::sequence);
    };
    auto found = find();
    if (found == touches_.end()) {
        take_touches();
        found = find();
    }
    if (found == touches_.end()) {
        return nullptr;
    }
    touches_.erase(touches_.begin(), found);
    return touches_.front().touch.get();
}

void Recorder::mark_lost(std::uint64_t lost) {
    if (lost != lost_marked_) {
        file_.gap(lost - lost_marked_);
        lost_marked_ = lost;
    }
}

void Recorder::drain() {
    while (const CycleRecord *record = cycles_.oldest()) {
        if (record->segment_start) {
            take_touches();
            mark_lost(record->lost_before);
            file_.memory(memory_);
            memory_full_.store(false, std::memory_order_release);
        }
        if (record->command_is_new) {
            const HapticCommand *const command = commands_.oldest();
            if (command == nullptr) {
                break; // the loop adds the command first: it is there
            }
            command_ = *command;
            commands_.pop();
            command_.touch = touch_of(command_.touch_sequence);
        }
        file_.cycle(*record, command_);
        cycles_.pop();
    }
    GameRead read;
    while (reads_.take(read)) {
        file_.read(read);
    }
    bytes_.store(file_.bytes(), std::memory_order_relaxed);
    failed_.store(!file_.good(), std::memory_order_relaxed);
}

void Recorder::write_in_time() {
    std::unique_lock lock(mutex_);
    for (int looks = 1; !stop_asked_; ++looks) {
        lock.unlock();
        drain();
        if (looks % kLooksPerFlush == 0) {
            file_.flush();
        }
        lock.lock();
        wake_.wait_for(lock, kLook, [this] { return stop_asked_; });
    }
}

RecorderStatistics Recorder::statistics() const noexcept {
    RecorderStatistics statistics;
    statistics.cycles = handed_over_.load(std::memory_order_relaxed);
    statistics.lost = lost_.load(std::memory_order_relaxed);
    statistics.bytes = bytes_.load(std::memory_order_relaxed);
    statistics.failed = failed_.load(std::memory_order_relaxed);
    return statistics;
}

} // namespace spidar
