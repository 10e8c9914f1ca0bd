// A device made of a plant and a hand: a drop-in Transport that needs no hardware. The hand's target and the
// faults are set from another thread (one at a time); the truth is read from that thread too, wait-free.
#pragma once

#include <memory>

#include "device/contract/transport.h"
#include "device/simulation/fault_injection.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

// A rigid grip of the simulated device has a sensor of how far its hand closes the fingers.
inline constexpr std::size_t kSqueezeSensor = 0;
inline constexpr double kSqueeze_1_rad = 1e4; // of HandTarget::grasp_angle_rad

class SimulatedTransport final : public Transport {
public:
    // Settings that do not validate() are kept out: open() then gives invalid_settings.
    explicit SimulatedTransport(const PlantSettings &settings);
    ~SimulatedTransport() override;

    Status open() noexcept override;
    // Currents to zero. The hand and the grip live on while advance() is called.
    void close() noexcept override;
    // One report at open() and one at each advance(): read_timeout when it has been read already.
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    void advance(double dt_s) noexcept override;
    [[nodiscard]] bool simulated() const noexcept override { return true; }

    // The counts at the home pose (rest_pose) of an ideal device, for calibrate_at_home().
    [[nodiscard]] CountArray home_counts() const noexcept;

    // From the controlling thread.
    void set_hand_target(const HandTarget &target) noexcept; // not finite: ignored
    void set_hand_firmness(HandFirmness firmness) noexcept;
    void set_buttons(std::uint8_t buttons) noexcept; // bit i: button i is held down
    // False, and nothing happens: not usable, or kMaxFaults are pending or active already. Its time starts at
    // the next advance(), open() or read().
    bool inject(const FaultInjection &fault) noexcept;
    void clear_faults() noexcept;
    // The plant at the end of the last finished advance().
    [[nodiscard]] PlantTruth truth() noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
