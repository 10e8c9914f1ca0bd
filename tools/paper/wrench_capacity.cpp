#include "paper/wrench_capacity.h"

#include <cmath>
#include <stdexcept>

namespace spidar::paper {

namespace {

// Only makes the optimum unique: costs a wrench of 10 N a billionth.
constexpr double kRidge = 1e-9;

TensionProblem problem_of(const WrenchMatrix &matrix, const PaperWrench &wrench,
                          double moment_weight, double max_tension_n) {
    TensionProblem problem;
    problem.matrix = matrix;
    problem.wrench = wrench;
    problem.weights = {1.0, 1.0, 1.0, moment_weight, moment_weight, moment_weight, moment_weight};
    problem.proximal_weight = kRidge;
    problem.upper_n.fill(max_tension_n);
    return problem;
}

StringArray solved(const TensionProblem &problem) {
    const TensionSolution solution = solve_tension_problem(problem, nullptr);
    if (!usable(solution.status)) {
        throw std::runtime_error(std::string("tension problem: ") + describe(solution.status));
    }
    return solution.tensions_n;
}

} // namespace

Capacity capacity_of(const WrenchMatrix &matrix, const PaperWrench &wrench, Weighting weighting,
                     double pole_half_length_m, double max_tension_n) {
    const double weight = weighting == Weighting::plain ? 1.0 : 1.0 / pole_half_length_m;
    Capacity result;
    result.tensions_n = solved(problem_of(matrix, wrench, weight, max_tension_n));
    result.achieved = apply(matrix, result.tensions_n);
    double along = 0.0;
    double size = 0.0;
    for (std::size_t k = 0; k < wrench.size(); ++k) {
        along += result.achieved[k] * wrench[k];
        size += wrench[k] * wrench[k];
    }
    result.ratio = along / size;
    for (std::size_t k = 0; k < wrench.size(); ++k) {
        result.unwanted[k] = result.achieved[k] - result.ratio * wrench[k];
    }
    return result;
}

double largest_exact(const WrenchMatrix &matrix, const PaperWrench &wrench,
                     double pole_half_length_m, double max_tension_n, double end) {
    constexpr int kBisections = 40;
    constexpr double kExact = 1e-6;
    const double weight = 1.0 / pole_half_length_m;
    double inside = 0.0;
    double outside = end;
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (inside + outside);
        PaperWrench wanted = wrench;
        for (double &value : wanted) {
            value *= middle;
        }
        const TensionProblem problem = problem_of(matrix, wanted, weight, max_tension_n);
        const PaperWrench given = apply(matrix, solved(problem));
        double miss = 0.0;
        double size = 0.0;
        for (std::size_t k = 0; k < wanted.size(); ++k) {
            miss += std::pow(problem.weights[k] * (given[k] - wanted[k]), 2);
            size += std::pow(problem.weights[k] * wanted[k], 2);
        }
        (miss <= kExact * kExact * size ? inside : outside) = middle;
    }
    return inside;
}

} // namespace spidar::paper
