// A device that a game drives: readings come from its transport, commands from the game's thread, stops from the host's
// watchdogs. Where a write may block, a thread of its own does it.
#pragma once

#include <memory>

#include "device/loop/host_watchdogs.h"
#include "device/step/cycle_source.h"
#include "device/threads/triple_buffer.h"
#include "device/threads/writer_thread.h"

namespace spidar {

class DeviceSource final : public CycleSource {
public:
    explicit DeviceSource(std::unique_ptr<Transport> transport)
        : transport_(std::move(transport)), writer_(*transport_) {}

    Status open() noexcept override;
    void close() noexcept override;
    Status begin(bool threaded) noexcept override;
    void motors_off() noexcept override;
    [[nodiscard]] bool simulated() const noexcept override { return transport_->simulated(); }
    [[nodiscard]] bool wait_report(std::int64_t until_ns) noexcept override {
        return transport_->wait_report(until_ns);
    }
    bool next(CycleGiven &given, ServoStep &step, EventLog &events) noexcept override;
    Status write(const DriveCommand &drive) noexcept override;
    void finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                double dt_s) noexcept override;
    void publish(const HapticCommand &command) noexcept override { commands_.write(command); }
    bool read_command(HapticCommand &command) noexcept override { return commands_.read(command); }
    void panic() noexcept override;

private:
    std::unique_ptr<Transport> transport_;
    WriterThread writer_;
    bool use_writer_ = false;
    bool is_open_ = false;
    TripleBuffer<HapticCommand> commands_;
    HostWatchdogs watchdogs_;
};

} // namespace spidar
