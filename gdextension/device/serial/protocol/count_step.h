// Checks whether a string can move as far as two successive replies of a board say.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "device/serial/protocol/board_layout.h"

namespace spidar {

struct CountLimits {
    // Largest speed of a string (unit: counts/s): 5 m/s at 25 um per count.
    double fastest_counts_s = 200'000.0;
    // Largest acceleration of a string (unit: counts/s^2): 100 m/s^2 at 25 um per count.
    double acceleration_counts_s2 = 4'000'000.0;
    // False: the reported speeds are ignored, for firmware that reports them in another unit.
    bool check_speeds = true;
};

// Contents of one reply to CURRENT.
struct BoardMotion {
    std::array<std::uint16_t, kMostBoardMotors> positions{}; // low 16 bits of the counts
    std::array<std::int16_t, kMostBoardMotors> speeds{};     // counts per control cycle
    std::array<std::int16_t, kMostBoardForces> forces{};     // of the board's force sensors
};

// Returns the step between two 16-bit counts, which wrap: -32768 to 32767.
[[nodiscard]] constexpr std::int32_t signed_step(std::uint16_t from, std::uint16_t to) noexcept {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(to - from));
}

// Uncertainty of a reply's arrival time behind a USB bridge (unit: s).
inline constexpr double kArrivalJitter_s = 0.002;
// Uncertainty of a reported speed (unit: counts per control cycle): 1 for rounding, 1 as margin.
inline constexpr double kSpeedRounding_counts = 2.0;

// True if no reported speed exceeds fastest_counts_s, or if speeds are not checked.
[[nodiscard]] inline bool speeds_are_possible(const BoardMotion &motion, const BoardLayout &board,
                                              const CountLimits &limits) noexcept {
    const double most = limits.fastest_counts_s / board.control_rate_hz() + kSpeedRounding_counts;
    return !limits.check_speeds ||
           std::all_of(motion.speeds.begin(),
                       motion.speeds.begin() + static_cast<std::ptrdiff_t>(board.motors()),
                       [most](std::int16_t speed) { return std::abs(speed) <= most; });
}

// True if each motor's step from `before` to `now` is within the limits and, if speeds are checked,
// agrees with the reported speeds. dt_s: time between the arrivals of both replies.
[[nodiscard]] inline bool step_is_possible(const BoardMotion &before, const BoardMotion &now,
                                           double dt_s, const BoardLayout &board,
                                           const CountLimits &limits) noexcept {
    const double time_s = std::max(dt_s, 0.0) + kArrivalJitter_s;
    for (std::size_t i = 0; i < board.motors(); ++i) {
        double most_s = limits.fastest_counts_s;
        if (limits.check_speeds) {
            const double reported = std::max(std::abs(before.speeds[i]), std::abs(now.speeds[i])) +
                                    kSpeedRounding_counts;
            most_s = std::min(most_s, reported * board.control_rate_hz() +
                                          limits.acceleration_counts_s2 * time_s);
        }
        if (std::abs(signed_step(before.positions[i], now.positions[i])) > most_s * time_s) {
            return false;
        }
    }
    return true;
}

} // namespace spidar
