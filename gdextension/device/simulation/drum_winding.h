// A drum whose radius shrinks as string is paid out, so that each turn pays out less than the one
// before. A fit of the paper's Table 1 gives 4.6 % of the radius over 0.7 m.
#pragma once

#include <algorithm>
#include <cmath>

namespace spidar {

// Length of string (unit: m) over which the drum's radius falls by `growth`.
inline constexpr double kFullWrap_m = 0.7;

struct DrumWinding {
    double growth = 0.0; // relative change of the radius over kFullWrap_m; 0: constant radius

    // Returns the drum's radius, relative to the one at wound_m = 0. wound_m: length of string paid
    // out since then.
    [[nodiscard]] double radius_share(double wound_m) const noexcept {
        return std::sqrt(std::max(kLeastSquare, 1.0 - 2.0 * growth / kFullWrap_m * wound_m));
    }
    // Returns the length that an encoder shows: what a drum of constant radius would have paid out
    // in the same turns.
    [[nodiscard]] double turned_m(double wound_m) const noexcept {
        return 2.0 * wound_m / (1.0 + radius_share(wound_m));
    }

private:
    // Lower limit of the squared relative radius, so that the root is real.
    static constexpr double kLeastSquare = 0.01;
};

} // namespace spidar
