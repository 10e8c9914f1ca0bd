// The table of motors: the board and the motor that pull each string, and the signs of the motor's
// counts and currents.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/types.h"
#include "device/serial/protocol/board_codec.h"

namespace spidar {

struct SerialMotor {
    int board_id = 0;     // id of the board on the bus, 0 to 7
    int motor = 0;        // index within the board
    int count_sign = 1;   // -1: counts fall as the string gets longer
    int current_sign = 1; // -1: negative currents pull
};
using SerialMotorTable = std::array<SerialMotor, kStringCount>;

// Returns the table that assigns strings 1, 2, ... to the motors of the first board, then to those
// of the next one. The signs are those of `signs`, and so are entries beyond the last motor.
[[nodiscard]] SerialMotorTable motors_in_order(std::span<const BoardLayout> boards,
                                               const SerialMotorTable &signs) noexcept;
// Returns an empty string when every string has its own motor on these boards and every sign is 1
// or -1, else one sentence.
[[nodiscard]] std::string validate(const SerialMotorTable &motors,
                                   std::span<const BoardLayout> boards);

// Returns each string's index into `boards`. Requires a validated table.
[[nodiscard]] std::array<std::size_t, kStringCount>
boards_of(const SerialMotorTable &motors, std::span<const BoardLayout> boards) noexcept;

// Board units per ampere if 4096 / 3.3 units stand for one volt, as in the usual host program.
// Follows from the published voltages for the X5R's motors and this project's default motor.
inline constexpr double kUsualUnitsPerAmpere = 618.0;

// Returns a current in board units: rounded, at most `most`, times sign. A negative current and NaN
// give 0.
[[nodiscard]] std::int16_t board_units(double current_a, double units_per_a, int most,
                                       int sign) noexcept;

// Appends a CURRENT command for every board. Motors without a string get zero current.
void append_currents(BoardFrame &frame, std::span<const BoardLayout> boards,
                     const SerialMotorTable &motors, const StringArray &currents_a,
                     double units_per_a, int most) noexcept;

} // namespace spidar
