// Which motor of which board pulls which string, and the signs of its numbers.
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
    int motor = 0;        // index within the board
    int count_sign = 1;   // -1: counts fall as the string gets longer
    int current_sign = 1; // -1: negative currents pull
};
using SerialMotorTable = std::array<SerialMotor, kStringCount>;

// Returns a table with boards by id and motors in their order; `signs` gives the signs.
[[nodiscard]] SerialMotorTable motors_in_order(std::span<const BoardLayout> boards,
                                               const SerialMotorTable &signs) noexcept;
// Returns an empty string when every string has its own motor on these boards, else one sentence.
[[nodiscard]] std::string validate(const SerialMotorTable &motors,
                                   std::span<const BoardLayout> boards);

// Returns each string's index into `boards`. Requires a validated table.
[[nodiscard]] std::array<std::size_t, kStringCount>
boards_of(const SerialMotorTable &motors, std::span<const BoardLayout> boards) noexcept;

// Board units per ampere of the usual host, which sends 4096 / 3.3 units per volt. Follows from the
// published voltages for the X5R's motors and this project's default motor.
inline constexpr double kUsualUnitsPerAmpere = 618.0;

// Returns a current in board units, clamped to `most`. NaN gives 0.
[[nodiscard]] std::int16_t board_units(double current_a, double units_per_a, int most,
                                       int sign) noexcept;

// Appends a CURRENT command for every board. Motors without a string get no current.
void append_currents(BoardFrame &frame, std::span<const BoardLayout> boards,
                     const SerialMotorTable &motors, const StringArray &currents_a,
                     double units_per_a, int most) noexcept;

} // namespace spidar
