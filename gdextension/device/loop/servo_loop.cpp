#include "device/loop/servo_loop.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "device/loop/servo_loop_impl.h"

namespace spidar {

ServoLoop::ServoLoop(std::unique_ptr<Transport> transport) : impl_(std::make_unique<Impl>()) {
    impl_->transport = std::move(transport);
    impl_->replay = impl_->transport->as_replay();
    impl_->writer.emplace(*impl_->transport);
}

ServoLoop::~ServoLoop() {
    stop();
}

Status ServoLoop::start_stepped(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    if (!usable(status)) {
        return status;
    }
    impl_->measured_rate_hz.store(settings.rate_hz, std::memory_order_relaxed);
    impl_->use_writer = false;
    impl_->is_running = true;
    impl_->is_threaded = false;
    return status;
}

Status ServoLoop::start_threaded(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    // Settings that are wrong stay wrong; a device may still be plugged in.
    const bool waits = settings.reopen_interval_s > 0.0 && status <= Status::not_open;
    if (!usable(status) && !waits) {
        return status;
    }
    impl_->use_writer = impl_->transport->write_may_block();
    if (impl_->use_writer && !usable(impl_->writer->start())) {
        impl_->transport->close();
        return Status::open_failed;
    }
    try {
        impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
    } catch (const std::system_error &) { // the system has no thread left
        impl_->writer->stop();
        impl_->transport->close();
        return Status::open_failed;
    }
    impl_->is_running = true;
    impl_->is_threaded = true;
    return Status::ok;
}

void ServoLoop::stop() noexcept {
    if (!impl_->is_running) {
        return;
    }
    if (impl_->is_threaded) {
        impl_->stop_asked.store(true, std::memory_order_release);
        impl_->thread.join();
        impl_->writer->stop(); // motors off
        impl_->cycle_began_ns.store(0, std::memory_order_release);
    } else {
        impl_->transport->write(DriveCommand());
    }
    stop_recording();
    impl_->recorders.clear(); // the loop rests: none is in use
    impl_->transport->close();
    impl_->is_running = false;
    impl_->is_threaded = false;
    // What a reader sees from now on: no device, no force.
    ServoSnapshot last = impl_->step.snapshot();
    last.state = DeviceState::closed;
    last.tensions_n = {};
    last.requested = Wrench();
    last.achieved = Wrench();
    last.force_scale = 0.0;
    last.at_min_mask = 0;
    last.at_max_mask = 0;
    last.grip.twist = Twist();
    last.grip.status = Status::not_open;
    impl_->snapshots.write(last);
}

bool ServoLoop::running() const noexcept {
    return impl_->is_running;
}

bool ServoLoop::threaded() const noexcept {
    return impl_->is_threaded;
}

int ServoLoop::advance(std::uint32_t numerator, std::uint32_t denominator) noexcept {
    Impl &impl = *impl_;
    if (!impl.is_running || impl.is_threaded || denominator == 0) {
        return 0;
    }
    // The rate as a fraction of whole millihertz keeps the sum exact: no drift in an hour of ticks.
    constexpr std::uint64_t kMillihertz = 1000;
    const auto rate_mhz =
        static_cast<std::uint64_t>(std::llround(impl.rate_hz * static_cast<double>(kMillihertz)));
    const std::uint64_t unit = denominator * kMillihertz;
    if (unit != impl.carry_denominator) { // another tick length: the rest to the nearest new unit
        const double part =
            static_cast<double>(impl.carry) / static_cast<double>(impl.carry_denominator);
        impl.carry = static_cast<std::uint64_t>(std::llround(part * static_cast<double>(unit)));
        impl.carry_denominator = unit;
    }
    const std::uint64_t sum = impl.carry + numerator * rate_mhz;
    impl.carry = sum % unit;
    const std::uint64_t cycles = std::min(sum / unit, kMostCyclesAtOnce);
    const FlushDenormals flush;
    for (std::uint64_t i = 0; i < cycles; ++i) {
        impl.cycle(impl.period_s);
    }
    return static_cast<int>(cycles);
}

void ServoLoop::publish(const HapticCommand &command) noexcept {
    impl_->commands.write(command);
}

void ServoLoop::panic_stop() noexcept {
    impl_->panics.fetch_add(1, std::memory_order_acq_rel);
    impl_->writer->forbid();
}

double ServoLoop::since_last_cycle_s() const noexcept {
    const std::int64_t began_ns = impl_->cycle_began_ns.load(std::memory_order_acquire);
    return began_ns != 0 ? static_cast<double>(monotonic_ns() - began_ns) * 1e-9 : 0.0;
}

bool ServoLoop::next_event(DeviceEvent &event) noexcept {
    return impl_->events.pop(event);
}

bool ServoLoop::latest(ServoSnapshot &snapshot) noexcept {
    return impl_->snapshots.read(snapshot);
}

LoopStatistics ServoLoop::statistics() const noexcept {
    const Impl &impl = *impl_;
    LoopStatistics statistics;
    statistics.measured_rate_hz = impl.measured_rate_hz.load(std::memory_order_relaxed);
    constexpr double kMedian = 0.5;
    constexpr double kTail = 0.99;
    statistics.lateness_p50_us = impl.lateness.quantile_us(kMedian);
    statistics.lateness_p99_us = impl.lateness.quantile_us(kTail);
    statistics.lateness_max_us = impl.lateness.max_us();
    statistics.step_p50_us = impl.step_time.quantile_us(kMedian);
    statistics.step_p99_us = impl.step_time.quantile_us(kTail);
    statistics.missed_deadlines = impl.missed_deadlines.load(std::memory_order_relaxed);
    statistics.late_cycles = impl.late_cycles.load(std::memory_order_relaxed);
    statistics.real_time_priority = impl.real_time_priority.load(std::memory_order_relaxed);
    return statistics;
}

std::array<std::uint32_t, LoopHistogram::kBuckets> ServoLoop::lateness_counts() const noexcept {
    std::array<std::uint32_t, LoopHistogram::kBuckets> counts{};
    for (int i = 0; i < LoopHistogram::kBuckets; ++i) {
        counts[static_cast<std::size_t>(i)] = impl_->lateness.count(i);
    }
    return counts;
}

std::string ServoLoop::start_recording(const std::string &path) {
    Impl &impl = *impl_;
    if (!impl.is_running) {
        return "No device is open: there is nothing to record. Open one first.";
    }
    if (recording()) {
        return "A recording runs already. Stop it before the next one starts.";
    }
    const std::uint64_t done = impl.cycles_done.load(std::memory_order_acquire);
    std::erase_if(impl.recorders, [done, &impl](const Impl::OwnedRecorder &owned) {
        return !impl.is_threaded || done >= owned.free_at_cycle;
    });
    auto recorder = std::make_unique<Recorder>(impl.settings_in_use, impl.is_threaded);
    std::string problem = recorder->open(path);
    if (problem.empty()) {
        impl.recorders.push_back({std::move(recorder)});
        impl.recorder.store(impl.recorders.back().recorder.get(), std::memory_order_release);
    }
    return problem;
}

void ServoLoop::stop_recording() noexcept {
    Recorder *const recorder = impl_->recorder.exchange(nullptr, std::memory_order_acq_rel);
    if (recorder != nullptr) {
        // The cycle that runs now may hold it, and the one that is about to begin has not seen the change.
        constexpr std::uint64_t kCyclesToLetGo = 2;
        impl_->recorders.back().free_at_cycle =
            impl_->cycles_done.load(std::memory_order_acquire) + kCyclesToLetGo;
        recorder->close();
        impl_->last_recording = recorder->statistics();
    }
}

bool ServoLoop::recording() const noexcept {
    return impl_->recorder.load(std::memory_order_relaxed) != nullptr;
}

RecorderStatistics ServoLoop::recording_statistics() const noexcept {
    const Recorder *const recorder = impl_->recorder.load(std::memory_order_relaxed);
    return recorder != nullptr ? recorder->statistics() : impl_->last_recording;
}

Transport &ServoLoop::transport() noexcept {
    return *impl_->transport;
}

} // namespace spidar
