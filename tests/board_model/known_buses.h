// Buses of boards that people have, and a motion that confirms their zero.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "board_model/board_bus.h"
#include "device/serial/motor_table.h"

namespace spidar::test {

inline constexpr BoardInfo kB3mInfo{5, 3, 4, 4, 0, 0};
inline constexpr BoardInfo kB5mInfo{7, 3, 8, 0, 4, 0};

inline BusSettings bus_of(std::vector<BoardLayout> boards) {
    BusSettings settings;
    settings.boards = std::move(boards);
    settings.units_per_a = kUsualUnitsPerAmpere;
    return settings;
}
inline BusSettings one_b5m() {
    return bus_of({{1, kB5mInfo, 0}});
}
inline BusSettings two_b3m() {
    return bus_of({{0, kB3mInfo, 0}, {1, kB3mInfo, 0}});
}

// Still at first, then round and round.
inline HandTarget wave(double time_s) {
    const double way = 1.5 * std::max(0.0, time_s - 1.0);
    HandTarget target;
    target.position_m =
        0.045 * Vec3(std::sin(4.0 * way), std::sin(3.0 * way), -std::sin(3.5 * way));
    return target;
}

} // namespace spidar::test
