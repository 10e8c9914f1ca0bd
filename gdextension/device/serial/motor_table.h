// Which motor of which board pulls which string, and what its numbers mean.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/types.h"
#include "device/serial/protocol/board_codec.h"

namespace spidar {

struct SerialMotor {
    int board_id = 0;     // on the bus, 0 to 7
    int motor = 0;        // of the board, from 0
    int count_sign = 1;   // -1: counts fall as the string gets longer
    int current_sign = 1; // -1: negative currents pull
};
using SerialMotorTable = std::array<SerialMotor, kStringCount>;

// The boards in the order of their ids, the motors of each in theirs; the signs are those of `signs`.
[[nodiscard]] SerialMotorTable motors_in_order(std::span<const BoardLayout> boards,
                                               const SerialMotorTable &signs) noexcept;
// Empty when every string has a motor of its own on these boards; else one sentence.
[[nodiscard]] std::string validate(const SerialMotorTable &motors,
                                   std::span<const BoardLayout> boards);

// Of each string: the place of its board among these. For a table that was validated.
[[nodiscard]] std::array<std::size_t, kStringCount>
boards_of(const SerialMotorTable &motors, std::span<const BoardLayout> boards) noexcept;

// What the usual host sends: 4096 / 3.3 units a volt. With the voltages that are published for the X5R's motors this is
// about as many for an ampere of this project's default motor.
inline constexpr double kUsualUnitsPerAmpere = 618.0;

// Unit: the board's. Never more than `most`, whatever is asked: a B5M keeps no limit of its own here. NaN gives 0.
[[nodiscard]] std::int16_t board_units(double current_a, double units_per_a, int most,
                                       int sign) noexcept;

// CURRENT for every board. Motors without a string get none.
void append_currents(BoardFrame &frame, std::span<const BoardLayout> boards,
                     const SerialMotorTable &motors, const StringArray &currents_a,
                     double units_per_a, int most) noexcept;

} // namespace spidar
