// One servo cycle between read and write: a deterministic, allocation-free function of
// (state, reading, command, time step). Same input, same bits: threaded, stepped, tests and replay all call it.
#pragma once

#include "core/forward_kinematics.h"
#include "core/tension_solver.h"
#include "device/haptic_command.h"
#include "device/servo_settings.h"
#include "device/servo_snapshot.h"
#include "device/transport.h"

namespace spidar {

// Everything that evolves from tick to tick lives in here.
class ServoStep {
public:
    // On a failure the old settings stand. Not from the servo loop.
    Status configure(const ServoSettings &settings) noexcept;

    // read_status: what Transport::read returned. may_arm_itself: simulated devices arm when forces are enabled.
    // Returns what to write; snapshot() holds the rest.
    DriveCommand step(Status read_status, const DeviceReading &reading, const HapticCommand &command,
                      double dt_s, bool may_arm_itself) noexcept;

    // A failed write: counted; device lost.
    void report_write(Status write_status) noexcept;

    [[nodiscard]] const ServoSnapshot &snapshot() const noexcept { return snapshot_; }

private:
    // (the "servo" part: kinematics_, solver_, renderer_, safety_gate_, filters, ages)
    ServoSnapshot snapshot_{};
};

} // namespace spidar
