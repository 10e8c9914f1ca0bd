// A device that a game drives: readings from the transport, commands from the game's thread, stops
// from the host's watchdogs. A writer thread is used where a write may block.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "device/loop/host_watchdogs.h"
#include "device/step/cycle_source.h"
#include "device/threads/triple_buffer.h"
#include "device/threads/writer_thread.h"

namespace spidar {

class DeviceSource final : public CycleSource {
public:
    explicit DeviceSource(std::unique_ptr<Transport> transport)
        : transport_(std::move(transport)), writer_(*transport_) {}

    Status open() noexcept override {
        const Status status = transport_->open();
        is_open_ = usable(status);
        return status;
    }
    void close() noexcept override {
        transport_->close();
        is_open_ = false;
    }
    Status begin(bool threaded) noexcept override {
        use_writer_ = threaded && transport_->write_may_block();
        return use_writer_ ? writer_.start() : Status::ok;
    }
    void motors_off() noexcept override {
        if (use_writer_) {
            writer_.stop();
            return;
        }
        for (int tries = 0; is_open_ && tries < kOffTries; ++tries) {
            if (usable(transport_->write(DriveCommand()))) {
                return;
            }
        }
    }
    [[nodiscard]] bool simulated() const noexcept override { return transport_->simulated(); }
    [[nodiscard]] bool wait_report(std::int64_t until_ns) noexcept override {
        return transport_->wait_report(until_ns);
    }

    bool next(CycleGiven &given, ServoStep & /*step*/, EventLog &events) noexcept override {
        const bool from_game = commands_.read(given.command);
        const bool stops =
            watchdogs_.watch(use_writer_ ? &writer_ : nullptr, given.command, events);
        given.command_is_new = from_game || stops;
        given.input.may_arm_itself = transport_->simulated();
        given.input.read_status = transport_->read(given.input.reading);
        return true;
    }
    [[nodiscard]] std::string device_name() const override { return transport_->device_name(); }
    Status write(const DriveCommand &drive) noexcept override {
        if (!use_writer_) {
            return transport_->write(drive);
        }
        writer_.post(drive);
        if (!drive.motors_on) {
            writer_.allow(); // the posted command switches off what a panic forbade
        }
        return writer_.take_result();
    }
    void finish(const ServoSnapshot & /*snapshot*/, const DriveCommand & /*drive*/,
                double dt_s) noexcept override {
        transport_->advance(dt_s);
    }

    void publish(const HapticCommand &command) noexcept override { commands_.write(command); }
    void restart(HapticCommand &command) noexcept override {
        (void)commands_.read(command);
        watchdogs_.restart(command);
    }
    void panic() noexcept override {
        watchdogs_.panic();
        writer_.forbid();
    }

private:
    static constexpr int kOffTries = 10; // attempts of a write that does not wait

    std::unique_ptr<Transport> transport_;
    WriterThread writer_;
    bool use_writer_ = false;
    bool is_open_ = false;
    TripleBuffer<HapticCommand> commands_;
    HostWatchdogs watchdogs_;
};

} // namespace spidar
