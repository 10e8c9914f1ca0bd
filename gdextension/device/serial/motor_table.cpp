#include "device/serial/motor_table.h"

#include <algorithm>

namespace spidar {

SerialMotorTable motors_in_order(std::span<const BoardLayout> boards,
                                 const SerialMotorTable &signs) noexcept {
    SerialMotorTable table = signs;
    std::size_t string = 0;
    for (const BoardLayout &board : boards) {
        for (std::size_t i = 0; i < board.motors() && string < table.size(); ++i) {
            table[string].board_id = board.id;
            table[string].motor = static_cast<int>(i);
            ++string;
        }
    }
    return table;
}

std::string validate(const SerialMotorTable &motors, std::span<const BoardLayout> boards) {
    std::size_t count = 0;
    for (const BoardLayout &board : boards) {
        count += board.motors();
    }
    if (count < motors.size()) {
        return "The boards on the bus have " + std::to_string(count) +
               " motors, and a SPIDAR-G needs " + std::to_string(motors.size()) +
               "; connect another board, or its cable.";
    }
    for (std::size_t i = 0; i < motors.size(); ++i) {
        const SerialMotor &one = motors[i];
        const std::string name = "String " + std::to_string(i + 1) + ": board " +
                                 std::to_string(one.board_id) + ", motor " +
                                 std::to_string(one.motor);
        const bool exists =
            std::any_of(boards.begin(), boards.end(), [&one](const BoardLayout &board) {
                return board.id == one.board_id && one.motor >= 0 &&
                       static_cast<std::size_t>(one.motor) < board.motors();
            });
        if (!exists) {
            return name +
                   " is not on the bus; correct the table of motors or the ids of the boards.";
        }
        for (std::size_t other = 0; other < i; ++other) {
            if (motors[other].board_id == one.board_id && motors[other].motor == one.motor) {
                return name + " pulls string " + std::to_string(other + 1) +
                       " already; give each string its own motor.";
            }
        }
        if (std::abs(one.count_sign) != 1 || std::abs(one.current_sign) != 1) {
            return name + " has a sign that is not 1 or -1; set both signs to 1 or -1.";
        }
    }
    return {};
}

std::array<std::size_t, kStringCount> boards_of(const SerialMotorTable &motors,
                                                std::span<const BoardLayout> boards) noexcept {
    std::array<std::size_t, kStringCount> places{};
    for (std::size_t i = 0; i < motors.size(); ++i) {
        for (std::size_t board = 0; board < boards.size(); ++board) {
            places[i] = boards[board].id == motors[i].board_id ? board : places[i];
        }
    }
    return places;
}

std::int16_t board_units(double current_a, double units_per_a, int most, int sign) noexcept {
    const double units = current_a * units_per_a;
    if (!(units > 0.0)) {
        return 0; // strings only pull
    }
    const double bounded = std::min(units + 0.5, static_cast<double>(most));
    return static_cast<std::int16_t>(sign * static_cast<int>(bounded));
}

void append_currents(BoardFrame &frame, std::span<const BoardLayout> boards,
                     const SerialMotorTable &motors, const StringArray &currents_a,
                     double units_per_a, int most) noexcept {
    for (const BoardLayout &board : boards) {
        BoardCurrents currents{};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const SerialMotor &motor = motors[i];
            if (motor.board_id == board.id) {
                currents[static_cast<std::size_t>(motor.motor)] =
                    board_units(currents_a[i], units_per_a, most, motor.current_sign);
            }
        }
        append_current(frame, board, currents);
    }
}

} // namespace spidar
