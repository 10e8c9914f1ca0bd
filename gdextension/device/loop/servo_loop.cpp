#include "device/loop/servo_loop.h"

#include <utility>

#include "device/loop/device_source.h"
#include "device/loop/servo_cycle.h"
#include "device/loop/servo_thread.h"
#include "device/loop/tick_accumulator.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

struct ServoLoop::Impl {
    explicit Impl(std::unique_ptr<CycleSource> source) : cycle(std::move(source)) {}

    // Ready for its first cycle, the source open if it can be.
    Status prepare(const ServoSettings &wanted) noexcept {
        const Status configured = cycle.configure(wanted);
        if (!usable(configured)) {
            return configured;
        }
        settings = wanted;
        ticks.restart(settings.rate_hz);
        return cycle.source().open();
    }

    ServoCycle cycle;
    LoopTiming timing;
    ServoThread thread{cycle, timing};
    TickAccumulator ticks; // stepped
    ServoSettings settings;
    bool is_running = false;
};

ServoLoop::ServoLoop(std::unique_ptr<CycleSource> source)
    : impl_(std::make_unique<Impl>(std::move(source))) {}

ServoLoop::ServoLoop(std::unique_ptr<Transport> transport)
    : ServoLoop(
          std::unique_ptr<CycleSource>(std::make_unique<DeviceSource>(std::move(transport)))) {}

ServoLoop::~ServoLoop() {
    stop();
}

Status ServoLoop::start_stepped(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    if (!usable(status)) {
        return status;
    }
    impl_->timing.restart(settings.rate_hz);
    impl_->is_running = true;
    return impl_->cycle.source().begin(false);
}

Status ServoLoop::start_threaded(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    // Settings that are wrong stay wrong; a device may still be plugged in.
    const bool waits = settings.reopen_interval_s > 0.0 && status <= Status::not_open;
    if (!usable(status) && !waits) {
        return status;
    }
    CycleSource &source = impl_->cycle.source();
    impl_->timing.restart(0.0);
    const bool begun = usable(source.begin(true));
    if (!begun || !usable(impl_->thread.start(settings, status))) { // the system has no thread left
        source.motors_off();
        source.close();
        return Status::open_failed;
    }
    impl_->is_running = true;
    return Status::ok;
}

void ServoLoop::stop() noexcept {
    if (!impl_->is_running) {
        return;
    }
    CycleSource &source = impl_->cycle.source();
    if (threaded()) {
        impl_->thread.stop();
    } else {
        source.motors_off();
    }
    impl_->cycle.recordings().stop_at_rest();
    source.close();
    impl_->is_running = false;
    impl_->cycle.show_closed();
}

bool ServoLoop::running() const noexcept {
    return impl_->is_running;
}

bool ServoLoop::threaded() const noexcept {
    return impl_->thread.running();
}

int ServoLoop::advance(std::uint32_t numerator, std::uint32_t denominator) noexcept {
    if (!running() || threaded() || denominator == 0) {
        return 0;
    }
    const std::uint64_t cycles = impl_->ticks.cycles(numerator, denominator);
    const double period_s = 1.0 / impl_->settings.rate_hz;
    const FlushDenormals flush;
    for (std::uint64_t i = 0; i < cycles; ++i) {
        impl_->cycle.run(period_s);
    }
    return static_cast<int>(cycles);
}

void ServoLoop::publish(const HapticCommand &command) noexcept {
    impl_->cycle.source().publish(command);
}

void ServoLoop::panic_stop() noexcept {
    impl_->cycle.source().panic();
}

double ServoLoop::since_last_cycle_s() const noexcept {
    return impl_->thread.since_last_cycle_s();
}

bool ServoLoop::next_event(DeviceEvent &event) noexcept {
    return impl_->cycle.next_event(event);
}

bool ServoLoop::latest(ServoSnapshot &snapshot) noexcept {
    return impl_->cycle.latest(snapshot);
}

LoopStatistics ServoLoop::statistics() const noexcept {
    return impl_->timing.statistics();
}

std::array<std::uint32_t, LoopHistogram::kBuckets> ServoLoop::lateness_counts() const noexcept {
    return impl_->timing.lateness_counts();
}

std::string ServoLoop::start_recording(const std::string &path) {
    return running() ? impl_->cycle.recordings().start(path, impl_->settings, threaded())
                     : "No device is open: there is nothing to record. Open one first.";
}

void ServoLoop::stop_recording() noexcept {
    impl_->cycle.recordings().stop();
}

bool ServoLoop::recording() const noexcept {
    return impl_->cycle.recordings().recording();
}

RecorderStatistics ServoLoop::recording_statistics() const noexcept {
    return impl_->cycle.recordings().statistics();
}

} // namespace spidar
