// A Transport made of a simulated plant and hand, without hardware. One other thread (the
// controlling thread) may set the hand's target and the faults, and read the true state; it never
// waits.
#pragma once

#include <memory>

#include "device/contract/transport.h"
#include "device/simulation/fault_injection.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

// Index of the sensor that shows the grasp angle of a rigid grip, which its strings do not measure:
// HandTarget::grasp_angle_rad.
inline constexpr std::size_t kSqueezeSensor = 0;
// Sensor units per radian of HandTarget::grasp_angle_rad.
inline constexpr double kSqueeze_1_rad = 1e4;

class SimulatedTransport final : public Transport {
public:
    // Unusable settings are not applied: open() then returns invalid_settings.
    explicit SimulatedTransport(const PlantSettings &settings);
    ~SimulatedTransport() override;

    Status open() noexcept override;
    // Sets the currents to zero. Hand and grip continue to move while advance() is called.
    void close() noexcept override;
    // Returns at most one report after open() and one after each advance(), else read_timeout.
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    void advance(double dt_s) noexcept override;
    [[nodiscard]] bool simulated() const noexcept override { return true; }

    // Returns the counts of an ideal device at the home pose (rest_pose), for calibrate_at_home().
    [[nodiscard]] CountArray home_counts() const noexcept;

    // Called from the controlling thread, like all functions below.
    void set_hand_target(const HandTarget &target) noexcept; // ignored when not finite
    void set_hand_firmness(HandFirmness firmness) noexcept;
    void set_buttons(std::uint8_t buttons) noexcept; // bit i: button i is pressed
    // Adds a fault, which the device takes over in its next advance(), open() or read(). Returns
    // false without effect when the fault is unusable or kMaxFaults are pending or active.
    bool inject(const FaultInjection &fault) noexcept;
    void clear_faults() noexcept;
    // Returns the plant's state after the last finished advance().
    [[nodiscard]] PlantTruth truth() noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
