// Faults that a simulated device can be told to have, and when, in simulated time.
#pragma once

#include <array>
#include <cstdint>

namespace spidar {

enum class SimulatedFault : std::uint8_t {
    output_cut = 0,        // currents never reach the motors
    frozen_counts = 1,     // the encoders stand still
    count_jump = 2,        // every count of string `string` is off by kCountJump
    read_timeout = 3,      // no reports
    unplugged = 4,         // open, read and write fail; motors without power
    stuck_encoder = 5,     // one string's count stands still
    broken_string = 6,     // one string pulls no more
    hand_released = 7,     // nobody holds the grip
    jammed_drum = 8,       // one drum is caught: its string goes slack or holds the grip back
    slipped_string = 9,    // one count creeps away by kSlip_m, and stays off while the fault lasts
    counts_reset = 10,     // the device restarts: counts and clock begin anew, and stay so
    reversed_encoder = 11, // one string's count runs the wrong way from here on
    swapped_encoders = 12, // the counts of this string and the next are exchanged
    reports_lost = 13,     // one in a hundred
    reports_repeated = 14, // one in a hundred comes a second time
    reports_swapped = 15,  // one in fifty is overtaken by the next
    late_output = 16,      // currents act 4 ms later
    blocked_output = 17,   // currents do not arrive; the last ones go on
};
inline constexpr int kSimulatedFaultCount = 18;

inline constexpr double kSlip_m = 0.020;
inline constexpr double kSlipSpeed_m_s = 0.2;
inline constexpr double kLateOutput_s = 0.004;
inline constexpr std::int32_t kCountJump = 1000; // 25 mm with the paper's pulley
inline constexpr int kMaxFaults = 8;

// A fault that lasts for ever when duration_s <= 0. start_s counts from the call.
struct FaultInjection {
    SimulatedFault fault = SimulatedFault::output_cut;
    int string = 0; // 0-7, where the fault has one
    double start_s = 0.0;
    double duration_s = 0.0;
};

// False: unknown fault, string outside 0-7, a time that is not finite, or a start before now.
[[nodiscard]] bool is_usable(const FaultInjection &fault) noexcept;

// A fault with a number that no other has; 0 is an empty place.
struct NumberedFault {
    std::uint32_t number = 0;
    FaultInjection injection;
};
using FaultList = std::array<NumberedFault, kMaxFaults>;

struct ActiveFaults {
    std::array<std::uint8_t, kSimulatedFaultCount> strings{}; // of each fault; bit i: string i
    std::array<double, 8> slip_m{};                           // of each string

    // Bit i: string i has it. A fault without a string has any bit.
    [[nodiscard]] std::uint8_t mask(SimulatedFault fault) const noexcept {
        return strings[static_cast<std::size_t>(fault)];
    }
    [[nodiscard]] bool has(SimulatedFault fault) const noexcept { return mask(fault) != 0; }
    [[nodiscard]] bool has(SimulatedFault fault, std::size_t string) const noexcept {
        return ((mask(fault) >> string) & 1U) != 0;
    }
};

// Runs faults on the simulated clock.
class FaultSchedule {
public:
    // The faults that there are now; a number not seen before starts counting from now_s.
    void set(const FaultList &faults, double now_s) noexcept;
    [[nodiscard]] ActiveFaults at(double now_s) const noexcept;
    // Numbers of faults that are over; 0 elsewhere.
    [[nodiscard]] std::array<std::uint32_t, kMaxFaults> finished(double now_s) const noexcept;

private:
    FaultList faults_{};
    std::array<double, kMaxFaults> begin_s_{};
    [[nodiscard]] double end_s(std::size_t place) const noexcept;
};

} // namespace spidar
