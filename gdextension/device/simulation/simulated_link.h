// The link between a simulated device and its host: it delays currents, and loses, repeats or swaps
// reports. Deterministic: equal settings and calls give equal results.
#pragma once

#include <array>
#include <cstdint>

#include "device/contract/transport.h"
#include "device/simulation/fault_injection.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

class SimulatedLink {
public:
    // Largest number of commands in transit (64 ms at 4 kHz); one more discards the oldest.
    static constexpr std::size_t kMostOnTheWay = 256;

    void configure(const PlantSettings &settings) noexcept;

    // Sends currents. extra_s: additional delay by a fault.
    void send(const StringArray &currents_a, double now_s, double extra_s) noexcept;
    // Discards all currents in transit, as when the device is unplugged.
    void cut() noexcept { count_ = 0; }
    // Returns the arrival time of the next currents (unit: s); infinity when none are in transit.
    [[nodiscard]] double next_s() const noexcept;
    // Returns the currents that arrive next and removes them.
    StringArray receive() noexcept;

    // Passes a report on to the host; faults may replace it. Returns false when no report arrives.
    bool deliver(DeviceReading &report, const ActiveFaults &faults) noexcept;

private:
    struct Sent {
        double due_s = 0.0;
        StringArray currents_a{};
    };
    double random() noexcept; // uniform in 0..1

    double latency_s_ = 0.0;
    double jitter_s_ = 0.0;
    double loss_ = 0.0;
    std::array<Sent, kMostOnTheWay> ring_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    double last_due_s_ = 0.0;
    std::uint64_t state_ = 1;
    DeviceReading held_;   // report that is delivered late
    DeviceReading before_; // last delivered report
    // Reports until held_ is delivered; 0: none is held.
    int held_for_ = 0;
    std::uint32_t made_ = 0;
};

} // namespace spidar
