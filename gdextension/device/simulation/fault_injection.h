// Faults that can be injected into a simulated device, with start and duration in simulated time.
#pragma once

#include <array>
#include <cstdint>

namespace spidar {

enum class SimulatedFault : std::uint8_t {
    output_cut = 0,    // currents never reach the motors
    frozen_counts = 1, // encoder counts stand still
    count_jump = 2,    // the string's count is off by kCountJump
    read_timeout = 3,  // no reports
    unplugged = 4,     // open, read and write fail; the motors have no power
    stuck_encoder = 5, // one string's count stands still
    broken_string = 6, // one string no longer pulls
    hand_released = 7, // nobody holds the grip
    jammed_drum = 8,   // one drum is blocked, so its string slackens or holds the grip back
    // The count of one string drifts off by kSlip_m and stays off while the fault lasts.
    slipped_string = 9,
    // The device restarts: counts and clock start from 0. The end of the fault does not restore
    // them.
    counts_reset = 10,
    reversed_encoder = 11, // one string's count runs backward while the fault lasts
    swapped_encoders = 12, // the counts of this string and the next are exchanged
    reports_lost = 13,     // one report in a hundred is lost
    reports_repeated = 14, // in place of one report in a hundred, the one before arrives again
    // one report in fifty arrives after the next one; the one after that is lost
    reports_swapped = 15,
    late_output = 16,    // currents act 4 ms later
    blocked_output = 17, // new currents do not arrive; the last ones stay
};
inline constexpr int kSimulatedFaultCount = 18;

// Error of a slipped string's length when the drift has ended (unit: m).
inline constexpr double kSlip_m = 0.020;
// Speed of the drift of a slipped string.
inline constexpr double kSlipSpeed_m_s = 0.2;
// Delay of late_output (unit: s).
inline constexpr double kLateOutput_s = 0.004;
inline constexpr std::int32_t kCountJump = 1000; // 25 mm with the paper's pulley
// Largest number of faults that are pending or active.
inline constexpr int kMaxFaults = 8;

// A fault with its time. start_s counts from when the device takes the fault over
// (SimulatedTransport::inject). duration_s <= 0: without end.
struct FaultInjection {
    SimulatedFault fault = SimulatedFault::output_cut;
    int string = 0; // 0-7, for faults of one string
    double start_s = 0.0;
    double duration_s = 0.0;
};

// Returns false for an unknown fault, string outside 0-7, non-finite time or negative start.
[[nodiscard]] bool is_usable(const FaultInjection &fault) noexcept;

// A fault with a unique number; 0 marks an empty place.
struct NumberedFault {
    std::uint32_t number = 0;
    FaultInjection injection;
};
using FaultList = std::array<NumberedFault, kMaxFaults>;

struct ActiveFaults {
    std::array<std::uint8_t, kSimulatedFaultCount> strings{}; // per fault; bit i: string i
    std::array<double, 8> slip_m{}; // present error of each slipped string

    // Returns the strings with this fault (bit i: string i). For a fault without a string some bit
    // is set.
    [[nodiscard]] std::uint8_t mask(SimulatedFault fault) const noexcept {
        return strings[static_cast<std::size_t>(fault)];
    }
    [[nodiscard]] bool has(SimulatedFault fault) const noexcept { return mask(fault) != 0; }
    [[nodiscard]] bool has(SimulatedFault fault, std::size_t string) const noexcept {
        return ((mask(fault) >> string) & 1U) != 0;
    }
};

// Decides which faults are active at a simulated time.
class FaultSchedule {
public:
    // Sets the list of faults. A fault with a new number starts counting at now_s.
    void set(const FaultList &faults, double now_s) noexcept;
    [[nodiscard]] ActiveFaults at(double now_s) const noexcept;
    // Returns the numbers of faults that have ended; 0 elsewhere.
    [[nodiscard]] std::array<std::uint32_t, kMaxFaults> finished(double now_s) const noexcept;

private:
    FaultList faults_{};
    std::array<double, kMaxFaults> begin_s_{};
    [[nodiscard]] double end_s(std::size_t place) const noexcept;
};

} // namespace spidar
