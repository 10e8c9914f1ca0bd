#include "core/tension/tension_report.h"

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Regularizing weight that stands for none: it changes no error, and the optimum stays unique.
constexpr double kVanishingWeight = 1e-12;

PaperWrench difference(const PaperWrench &a, const PaperWrench &b) noexcept {
    PaperWrench result{};
    for (std::size_t k = 0; k < kDofCount; ++k) {
        result[k] = a[k] - b[k];
    }
    return result;
}

} // namespace

PaperWrench TensionReport::bias() const noexcept {
    PaperWrench sum{};
    for (std::size_t k = 0; k < kDofCount; ++k) {
        sum[k] = ridge[k] + reference[k];
    }
    return sum;
}

TensionReport tension_report(const WrenchMatrix &matrix, const PaperWrench &wrench,
                             const StringArray &tensions_n,
                             const TensionSettings &settings) noexcept {
    TensionReport report;
    TensionSolver checked;
    report.status = checked.configure(settings);
    if (!usable(report.status)) {
        return report;
    }
    const PaperWrench achieved = spidar::apply(matrix, tensions_n);
    TensionProblem problem;
    problem.matrix = matrix;
    problem.wrench = wrench;
    problem.weights = tension_weights(settings);
    StringArray reference_n{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool works = !has_string(settings.broken_mask, i);
        problem.lower_n[i] = works ? settings.min_tension_n : 0.0;
        problem.upper_n[i] = works ? settings.max_tension_n : 0.0;
        reference_n[i] = works ? settings.reference_tension_n : 0.0;
    }
    TensionSolution steady;
    const auto error_with = [&](double weight, const StringArray &target_n) {
        problem.proximal_weight = weight;
        problem.proximal_target_n = target_n;
        steady = solve_tension_problem(problem, nullptr);
        if (!usable(steady.status)) {
            report.status = steady.status;
        }
        return difference(spidar::apply(matrix, steady.tensions_n), wrench);
    };
    const PaperWrench limits = error_with(kVanishingWeight, tensions_n);
    const PaperWrench with_ridge =
        settings.ridge > kVanishingWeight ? error_with(settings.ridge, StringArray{}) : limits;
    const double weight = settings.ridge + settings.reference_weight;
    StringArray target_n{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        target_n[i] = settings.reference_weight * reference_n[i] / weight;
    }
    const PaperWrench whole = error_with(weight, target_n);
    if (!all_finite(achieved) || !usable(report.status)) {
        report.status = usable(report.status) ? Status::not_finite : report.status;
        return report;
    }
    report.achieved = achieved;
    report.error = difference(achieved, wrench);
    report.limits = limits;
    report.ridge = difference(with_ridge, limits);
    report.reference = difference(whole, with_ridge);
    report.transient = difference(report.error, whole);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool works = problem.lower_n[i] < problem.upper_n[i];
        if (works && steady.active[i] == StringBound::at_lower) {
            report.at_min_mask = with_string(report.at_min_mask, i);
        } else if (works && steady.active[i] == StringBound::at_upper) {
            report.at_max_mask = with_string(report.at_max_mask, i);
        }
    }
    for (std::size_t k = 0; k < kDofCount; ++k) {
        if (std::abs(problem.weights[k] * limits[k]) > kNoticeableLimit_n) {
            report.status = Status::wrench_limited;
        }
    }
    return report;
}

} // namespace spidar
