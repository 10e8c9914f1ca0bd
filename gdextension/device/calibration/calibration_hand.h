// Targets of the simulated device's hand during calibration, where no game moves the grip.
#pragma once

#include <cstdint>

#include "device/simulation/simulated_plant.h"

namespace spidar {

enum class HandScript : std::uint8_t {
    home = 0, // the grip's rest pose
    // All DOF of the grip at once, each by a sine of another frequency, within the reach.
    free_motion = 1,
    // One of kHandPlaces fixed places, where lengths are measured with a ruler.
    place = 2,
};

// Number of fixed places.
inline constexpr int kHandPlaces = 8;

// Returns the target. place is taken modulo kHandPlaces. time_s: time since the script began.
[[nodiscard]] HandTarget calibration_hand(const PlantSettings &plant, HandScript script, int place,
                                          double time_s) noexcept;

} // namespace spidar
