// Where the hand of a simulated device goes while it is calibrated: there nobody else moves the grip.
#pragma once

#include <cstdint>

#include "device/simulation/simulated_plant.h"

namespace spidar {

enum class HandScript : std::uint8_t {
    home = 0,        // the grip's rest pose
    free_motion = 1, // all seven DOF at once, by incommensurate sines, within the workspace
    place = 2,       // one of kHandPlaces fixed places, for lengths by the ruler
};

inline constexpr int kHandPlaces = 8;

// place: taken modulo kHandPlaces. time_s: since the script began.
[[nodiscard]] HandTarget calibration_hand(const PlantSettings &plant, HandScript script, int place,
                                          double time_s) noexcept;

} // namespace spidar
