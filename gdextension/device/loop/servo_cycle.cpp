#include "device/loop/servo_cycle.h"

#include <exception>

#include "device/safety/motor_heat.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

Status ServoCycle::configure(const ServoSettings &settings) noexcept {
    const Status configured = step_.configure(settings);
    if (!usable(configured)) {
        return configured;
    }
    source_->restart(given_.command);
    step_.acknowledge(given_.command);
    given_.input = CycleInput();
    tick_ = 0;
    host_events_ = EventLog();
    thermal_time_s_ = settings.safety.thermal_time_s;
    return configured;
}

void ServoCycle::recall_heat() noexcept {
    try {
        const std::string device = source_->device_name();
        if (!device.empty()) {
            step_.set_heat(recall_motor_heat(device, monotonic_ns()));
        }
    } catch (const std::exception &) { // no memory for a name
        step_.set_heat({});
    }
}

bool ServoCycle::keep_heat() noexcept {
    try {
        keep_motor_heat(source_->device_name(), step_.heat(), thermal_time_s_, monotonic_ns());
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

void ServoCycle::recall() noexcept {
    if (source_->recall(step_)) {
        tick_ = step_.snapshot().counters.ticks;
        snapshots_.write(step_.snapshot());
    }
}

bool ServoCycle::run(double dt_s) noexcept SPIDAR_NONBLOCKING {
    Recorder *const recorder = recordings_.current();
    CycleInput &input = given_.input;
    input.dt_s = dt_s;
    if (!source_->next(given_, step_, host_events_)) {
        return false; // the end: the last published snapshot stays
    }
    if (recorder != nullptr) {
        recorder->begin(step_);
    }
    const DriveCommand drive = step_.step(input.read_status, input.reading, given_.command,
                                          input.dt_s, input.may_arm_itself);
    const bool lost = step_.snapshot().state == DeviceState::closed;
    input.write_status = source_->write(drive);
    if (!lost) {
        step_.report_write(input.write_status); // a lost device must not be lost twice
    }
    const ServoSnapshot &snapshot = step_.snapshot();
    if (recorder != nullptr) {
        recorder->end(input, drive, snapshot, given_.command, given_.command_is_new);
    }
    for (const auto &log : {step_.events(), host_events_.events()}) {
        for (const DeviceEvent &event : log) {
            events_.offer(event);
        }
    }
    host_events_.begin_cycle(snapshot.time_s);
    const ServoSnapshot *const instead = source_->shown(snapshot);
    const ServoSnapshot &shown = instead != nullptr ? *instead : snapshot;
    tick_ = shown.counters.ticks;
    snapshots_.write(shown);
    source_->finish(snapshot, drive, input.dt_s);
    recordings_.end_cycle();
    return true;
}

void ServoCycle::show_open_failed(Status why) noexcept {
    ServoSnapshot closed;
    closed.fault = why;
    snapshots_.write(closed);
    events_.offer({0.0, 0.0, DeviceEventKind::open_failed, -1, 0});
}

void ServoCycle::show_closed() noexcept {
    ServoSnapshot last = step_.snapshot();
    last.state = DeviceState::closed; // no device, no force
    last.tensions_n = {};
    last.requested = Wrench();
    last.achieved = Wrench();
    last.force_scale = 0.0;
    last.at_min_mask = 0;
    last.at_max_mask = 0;
    last.grip.twist = Twist();
    last.grip.status = Status::not_open;
    snapshots_.write(last);
}

} // namespace spidar
