// The wire between a simulated device and its host: currents arrive late, reports get lost, repeated or swapped.
// Deterministic: the same settings and the same order of calls give the same delays.
#pragma once

#include <array>
#include <cstdint>

#include "device/contract/transport.h"
#include "device/simulation/fault_injection.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

class SimulatedLink {
public:
    // Commands on their way at once: 64 ms of them at 4 kHz.
    static constexpr std::size_t kMostOnTheWay = 256;

    void configure(const PlantSettings &settings) noexcept;

    // Currents that the host sent now. extra_s: a fault's delay on top.
    void send(const StringArray &currents_a, double now_s, double extra_s) noexcept;
    // Everything on its way is lost: unplugged.
    void cut() noexcept { count_ = 0; }
    // When the next currents arrive (unit: s); infinity when none are on their way.
    [[nodiscard]] double next_s() const noexcept;
    // The currents that arrive next.
    StringArray receive() noexcept;

    // A report that the device made: what of it reaches the host. False: nothing this time.
    bool deliver(DeviceReading &report, const ActiveFaults &faults) noexcept;

private:
    struct Sent {
        double due_s = 0.0;
        StringArray currents_a{};
    };
    double random() noexcept; // 0..1

    double latency_s_ = 0.0;
    double jitter_s_ = 0.0;
    double loss_ = 0.0;
    std::array<Sent, kMostOnTheWay> ring_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    double last_due_s_ = 0.0;
    std::uint64_t state_ = 1;
    DeviceReading held_;   // kept back to be delivered late
    DeviceReading before_; // delivered last
    int held_for_ = 0;     // reports until it is delivered; 0: none is held
    std::uint32_t made_ = 0;
};

} // namespace spidar
