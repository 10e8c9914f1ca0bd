// What some tensions give of a request, and what keeps the rest back. Looked at when asked, not in the servo step:
// four solves without haste.
#pragma once

#include "core/tension/tension_solver.h"

namespace spidar {

// error = limits + ridge + reference + transient, in every DOF (unit: N, N m, order of the paper's q).
struct TensionReport {
    PaperWrench achieved{}; // A tau
    PaperWrench error{};    // A tau - q
    // Steady shares, strings at bounds included:
    PaperWrench
        limits{}; // what bounds, broken strings and lost rank leave, with no regularising term at all
    PaperWrench ridge{};     // what the ridge adds to that
    PaperWrench reference{}; // what the pull to the reference tension adds
    // What would vanish if request and pose stood still: change term, slew limit.
    PaperWrench transient{};
    std::uint8_t at_min_mask = 0; // bit i: string i would be at its bound then
    std::uint8_t at_max_mask = 0;
    // wrench_limited when `limits` weighs more than kNoticeableLimit_n; negative: nothing above is known.
    Status status = Status::ok;

    // ridge + reference: the steady cost of the regularising terms.
    [[nodiscard]] PaperWrench bias() const noexcept;
};

// Unit: N at the pole ends; a tenth of what a fingertip can tell.
inline constexpr double kNoticeableLimit_n = 1e-3;

// `tensions_n`: what is sent to the strings for `wrench` at the pose of `matrix`. DOF that the mask leaves out are
// reported as they are. Not finite input or settings out of range: negative status and zeros.
[[nodiscard]] TensionReport tension_report(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                           const StringArray &tensions_n,
                                           const TensionSettings &settings) noexcept;

} // namespace spidar
