// A device made of a plant and a hand: a drop-in Transport that needs no hardware. The hand's target and the
// faults are set from another thread (one at a time); the truth is read from that thread too, wait-free.
#pragma once

#include <memory>

#include "device/simulated_plant.h"
#include "device/transport.h"

namespace spidar {

enum class SimulatedFault : std::uint8_t {
    output_cut = 0,     // currents never reach the motors
    frozen_counts = 1,  // the encoders stand still
    count_jump = 2,     // every count of string `string` is off by 1000
    read_timeout = 3,   // no reports
    unplugged = 4,      // read and write fail
    stuck_encoder = 5,  // one string's count stands still
    broken_string = 6,  // one string pulls no more
};

// A fault that lasts for ever when duration_s <= 0. start_s counts from the call.
struct FaultInjection {
    SimulatedFault fault = SimulatedFault::output_cut;
    int string = 0;
    double start_s = 0.0;
    double duration_s = 0.0;
};

class SimulatedTransport final : public Transport {
public:
    explicit SimulatedTransport(const PlantSettings &settings);
    ~SimulatedTransport() override;

    Status open() noexcept override;
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    void advance(double dt_s) noexcept override;
    [[nodiscard]] bool simulated() const noexcept override { return true; }

    // The counts at the home pose (rest_pose) of an ideal device, for calibrate_at_home().
    [[nodiscard]] CountArray home_counts() const noexcept;

    // From the controlling thread.
    void set_hand_target(const HandTarget &target) noexcept; // not finite: ignored
    void set_hand_firmness(HandFirmness firmness) noexcept;
    void inject(const FaultInjection &fault) noexcept;       // up to 8 at a time
    void clear_faults() noexcept;
    // The plant at the end of the last finished cycle.
    [[nodiscard]] PlantTruth truth() noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
