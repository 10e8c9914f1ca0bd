// A drum that is fuller near the zero than far out: the string lies on itself,
// so that a turn pays out less the more has been paid out already (the paper's
// Table 1 fits 4.6 % over 0.7 m).
#pragma once

#include <algorithm>
#include <cmath>

namespace spidar {

// The string of a full wrap, over which a drum's radius falls by its growth.
inline constexpr double kFullWrap_m = 0.7;

struct DrumWinding {
    double growth = 0.0; // of the radius over a full wrap, relative; 0: a drum of one radius

    // The drum's radius after this much string has left it, of that at the zero.
    [[nodiscard]] double radius_share(double wound_m) const noexcept {
        return std::sqrt(std::max(kLeastSquare, 1.0 - 2.0 * growth / kFullWrap_m * wound_m));
    }
    // What a drum of one radius would have paid out in the turns that paid out
    // wound_m here: what an encoder shows.
    [[nodiscard]] double turned_m(double wound_m) const noexcept {
        return 2.0 * wound_m / (1.0 + radius_share(wound_m));
    }

private:
    static constexpr double kLeastSquare = 0.01; // an empty drum; no frame is as large
};

} // namespace spidar
