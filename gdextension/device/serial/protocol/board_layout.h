// Protocol of the serial motor boards B1M to B5M (docs/reference/serial_boards.md): numbers of the
// commands, and lengths of commands and replies in bytes, header included. Written from public
// sources; not tested on hardware.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

inline constexpr std::uint32_t kBoardBaud = 2'000'000;
inline constexpr std::size_t kMostBoards = 8; // ids 0 to 7
inline constexpr std::size_t kMostBoardMotors = 8;
inline constexpr std::size_t kMostBoardForces = 8;
inline constexpr std::size_t kBoardCommandCount = 12; // commands 0 to 11

enum class BoardCommand : std::uint8_t {
    none = 0, // padding byte
    info = 1,
    set_command_lengths = 2,
    all = 3,
    sensor = 4,
    direct = 5,
    current = 6,
    interpolate = 7,
    force_control = 8,
    set_parameter = 9,
    reset = 10,
    get_parameter = 11,
};

enum class BoardParameter : std::uint8_t {
    position_gains = 0,
    current_gains = 1,
    torque_limits = 2,
    board_id = 3,
    heat_limits = 5,
    magnets = 6,
    quadrature_mask = 7, // 32 bits; bit i: motor i has a quadrature encoder
    pwm_period = 8,
};

enum class BoardModel : std::uint8_t { b1m = 1, b1f, b2m, b2f, b3m, b3f, b5m };

// Model of a board and number of its channels of each kind: the content of INFO's reply.
struct BoardInfo {
    std::uint8_t model = 0;
    std::uint8_t targets = 0;
    std::uint8_t motors = 0;
    std::uint8_t currents = 0;
    std::uint8_t forces = 0;
    std::uint8_t touches = 0;

    friend bool operator==(const BoardInfo &, const BoardInfo &) = default;
};

// Returns a name such as "B5M", or "unknown board". The text is static.
[[nodiscard]] const char *name_of_model(std::uint8_t model) noexcept;

struct BoardLayout {
    std::uint8_t id = 0;
    BoardInfo info;
    // 16-bit words that the firmware appends to CURRENT's reply. Some builds append the currents of
    // all motors, others nothing.
    std::uint8_t extra_words = 0;

    [[nodiscard]] std::size_t motors() const noexcept { return info.motors; }
    // Rate of the firmware's control loop (unit: Hz). Boards report speeds in counts per cycle of
    // this loop.
    [[nodiscard]] double control_rate_hz() const noexcept {
        return info.model == static_cast<std::uint8_t>(BoardModel::b5m) ? 11'100.0 : 3'000.0;
    }
};

[[nodiscard]] constexpr std::uint8_t board_header(BoardCommand command, std::uint8_t id) noexcept {
    return static_cast<std::uint8_t>(static_cast<unsigned>(command) << 3U | (id & 7U));
}

// Returns the length of a command without the zeros after it.
[[nodiscard]] std::size_t command_length(const BoardLayout &board, BoardCommand command) noexcept;
// Returns the length of a command's reply; 0 if there is none, and for all, interpolate and
// force_control, which this host never sends.
[[nodiscard]] std::size_t reply_length(const BoardLayout &board, BoardCommand command) noexcept;
// Returns the number of zeros to send after a command. They clock the reply out. They also fill the
// board's receive buffer, which interrupts at six bytes, so that the board sees the command's end.
[[nodiscard]] std::size_t padding(const BoardLayout &board, BoardCommand command) noexcept;

// True for a board that this host can drive: a known model with 1 to 8 motors, at most 8 force
// sensors, and fewer than 100 motors, currents and force sensors in all.
[[nodiscard]] bool is_plausible(const BoardInfo &info) noexcept;

} // namespace spidar
