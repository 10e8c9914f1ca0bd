// A drum whose radius shrinks as string is paid out, so that a turn pays out less and less. The
// paper's Table 1 fits 4.6 % over 0.7 m.
#pragma once

#include <algorithm>
#include <cmath>

namespace spidar {

// Length of string (unit: m) over which the drum's radius falls by `growth`.
inline constexpr double kFullWrap_m = 0.7;

struct DrumWinding {
    double growth = 0.0; // relative change of the radius over kFullWrap_m; 0: constant radius

    // Returns the drum's radius, relative to that at the zero, after this much string was paid out.
    [[nodiscard]] double radius_share(double wound_m) const noexcept {
        return std::sqrt(std::max(kLeastSquare, 1.0 - 2.0 * growth / kFullWrap_m * wound_m));
    }
    // Returns the length that an encoder shows: what a drum of constant radius would have paid out
    // in the same turns.
    [[nodiscard]] double turned_m(double wound_m) const noexcept {
        return 2.0 * wound_m / (1.0 + radius_share(wound_m));
    }

private:
    // Radius squared of an empty drum; no frame is large enough to reach it.
    static constexpr double kLeastSquare = 0.01;
};

} // namespace spidar
