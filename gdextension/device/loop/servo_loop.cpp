#include "device/loop/servo_loop.h"

#include "device/loop/device_source.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

ServoLoop::ServoLoop(std::unique_ptr<Transport> transport)
    : cycle_(std::make_unique<DeviceSource>(std::move(transport))) {}

Status ServoLoop::prepare(const ServoSettings &settings) noexcept {
    const Status configured = cycle_.configure(settings);
    if (!usable(configured)) {
        return configured;
    }
    settings_ = settings;
    ticks_.restart(settings.rate_hz);
    return cycle_.source().open();
}

Status ServoLoop::start_stepped(const ServoSettings &settings) {
    stop();
    const Status status = prepare(settings);
    if (!usable(status)) {
        return status;
    }
    cycle_.recall_heat();
    cycle_.recall();
    timing_.restart(settings.rate_hz);
    is_running_ = true;
    return cycle_.source().begin(false);
}

Status ServoLoop::start_threaded(const ServoSettings &settings) {
    stop();
    const Status status = prepare(settings);
    // Wrong settings stay wrong, but a device may still be plugged in.
    const bool waits = settings.reopen_interval_s > 0.0 && status <= Status::not_open;
    if (!usable(status) && !waits) {
        return status;
    }
    timing_.restart(0.0);
    CycleSource &source = cycle_.source();
    if (!usable(source.begin(true)) || !usable(thread_.start(settings, status))) {
        source.motors_off(); // the system has no thread left
        source.close();
        return Status::open_failed;
    }
    is_running_ = true;
    return Status::ok;
}

void ServoLoop::stop() noexcept {
    if (!is_running_) {
        return;
    }
    if (threaded()) {
        thread_.stop();
    } else {
        cycle_.source().motors_off();
    }
    cycle_.recordings().stop_at_rest();
    (void)cycle_.keep_heat();
    cycle_.source().close();
    is_running_ = false;
    cycle_.show_closed();
}

int ServoLoop::advance(std::uint32_t numerator, std::uint32_t denominator) noexcept {
    if (!running() || threaded() || denominator == 0) {
        return 0;
    }
    const std::uint64_t cycles = ticks_.cycles(numerator, denominator);
    const double period_s = 1.0 / settings_.rate_hz;
    const FlushDenormals flush;
    for (std::uint64_t i = 0; i < cycles; ++i) {
        cycle_.run(period_s);
    }
    return static_cast<int>(cycles);
}

void ServoLoop::advance_to(std::uint64_t tick) noexcept {
    if (!running() || threaded()) {
        return;
    }
    const FlushDenormals flush;
    while (cycle_.tick() < tick && cycle_.run(1.0 / settings_.rate_hz)) {
    }
}

void ServoLoop::publish(HapticCommand &command, std::shared_ptr<const TouchScene> touch) {
    command.touch = touch.get();
    ++command.touch_sequence;
    touches_.push_back({command.touch_sequence, std::move(touch)});
    cycle_.recordings().note(touches_.back());
    publish(command);
}

bool ServoLoop::latest(ServoSnapshot &snapshot) noexcept {
    const bool is_newer = cycle_.latest(snapshot);
    // The loop owns the shapes of the scene that it renders, and uses no older scene.
    while (is_newer && !touches_.empty() && touches_.front().sequence < snapshot.touch.sequence) {
        touches_.pop_front();
    }
    return is_newer;
}

} // namespace spidar
