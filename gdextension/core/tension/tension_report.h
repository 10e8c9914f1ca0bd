// Which wrench some tensions achieve of a requested wrench, and the causes of the error. Takes up
// to three solves: for diagnosis, not for the servo step.
#pragma once

#include "core/tension/tension_solver.h"

namespace spidar {

// error = limits + ridge + reference + transient, per DOF, in the order and units (N, N m) of the
// paper's q.
struct TensionReport {
    PaperWrench achieved{}; // A tau
    PaperWrench error{};    // A tau - q
    // Error by bounds, broken strings and lost rank, without any regularizing term. `limits`,
    // `ridge` and `reference` are the errors that remain if request and pose stand still.
    PaperWrench limits{};
    PaperWrench ridge{};     // error that the ridge adds to `limits`
    PaperWrench reference{}; // error that the pull to the reference tension adds
    // Error that would vanish if request and pose stood still: change term and slew limit.
    PaperWrench transient{};
    // Strings at their lower bound in the steady solution (bit i: string i).
    std::uint8_t at_min_mask = 0;
    // Strings at their upper bound in the steady solution.
    std::uint8_t at_max_mask = 0;
    // wrench_limited when some element of `limits`, times its weight in the settings
    // (TensionSettings::weight_...), exceeds kNoticeableLimit_n. If the status is negative, all
    // values of the report are zero.
    Status status = Status::ok;

    // Returns ridge + reference: the steady error of the regularizing terms.
    [[nodiscard]] PaperWrench bias() const noexcept;
};

// Smallest weighted error that sets wrench_limited (N at the pole ends): a tenth of what a
// fingertip feels.
inline constexpr double kNoticeableLimit_n = 1e-3;

// tensions_n: the tensions that were sent for `wrench` at the pose of `matrix`. A DOF outside the
// mask is reported too, with the value that these tensions happen to give. For input that is not
// finite or settings out of range the status is negative and all values are zero.
[[nodiscard]] TensionReport tension_report(const WrenchMatrix &matrix, const PaperWrench &wrench,
                                           const StringArray &tensions_n,
                                           const TensionSettings &settings) noexcept;

} // namespace spidar
