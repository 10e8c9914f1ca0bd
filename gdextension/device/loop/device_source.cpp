#include "device/loop/device_source.h"

namespace spidar {

Status DeviceSource::open() noexcept {
    const Status status = transport_->open();
    is_open_ = usable(status);
    return status;
}

void DeviceSource::close() noexcept {
    transport_->close();
    is_open_ = false;
}

Status DeviceSource::begin(bool threaded) noexcept {
    watchdogs_.restart();
    use_writer_ = threaded && transport_->write_may_block();
    return use_writer_ ? writer_.start() : Status::ok;
}

void DeviceSource::motors_off() noexcept {
    if (use_writer_) {
        writer_.stop();
    } else if (is_open_) {
        transport_->write(DriveCommand());
    }
}

bool DeviceSource::next(CycleGiven &given, ServoStep & /*step*/, EventLog &events) noexcept {
    const bool from_game = commands_.read(given.command);
    const bool stops = watchdogs_.watch(use_writer_ ? &writer_ : nullptr, given.command, events);
    given.command_is_new = from_game || stops;
    given.input.may_arm_itself = transport_->simulated();
    given.input.read_status = transport_->read(given.input.reading);
    return true;
}

Status DeviceSource::write(const DriveCommand &drive) noexcept {
    if (!use_writer_) {
        return transport_->write(drive);
    }
    writer_.post(drive);
    if (!drive.motors_on) {
        writer_.allow(); // what a panic forbade is off in what is posted, too
    }
    return writer_.take_result();
}

void DeviceSource::finish(const ServoSnapshot & /*snapshot*/, const DriveCommand & /*drive*/,
                          double dt_s) noexcept {
    transport_->advance(dt_s);
}

void DeviceSource::panic() noexcept {
    watchdogs_.panic();
    writer_.forbid();
}

} // namespace spidar
