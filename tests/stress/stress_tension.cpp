// Random tension problems of every kind against an independent optimum in quad precision, cold and warm.
//   stress_tension --cases N --seed S      case i is problem S + i: --cases 1 --seed S+i replays it
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "core/tension/tension_solver.h"
#include "support/exact_optimum.h"
#include "support/problem_generator.h"

namespace {

using namespace spidar;

// Published tolerances (README of the reference data).
constexpr double kTensionTolerance_n = 1e-8;
constexpr double kObjectiveTolerance = 1e-12;

struct Worst {
    long cases = 0;
    long failures = 0;
    double tension_n = 0.0;
    unsigned long long tension_seed = 0;
    double objective = 0.0;
    unsigned long long objective_seed = 0;
    int iterations = 0;
    unsigned long long iterations_seed = 0;
    long iteration_sum = 0;
};

bool check(const TensionProblem &problem, const ActiveSet *warm, unsigned long long seed,
           Worst &worst) {
    const TensionSolution solution = solve_tension_problem(problem, warm);
    const test::Certificate truth = test::certify(problem, solution.tensions_n);
    if (truth.tension_error_n > worst.tension_n) {
        worst.tension_n = truth.tension_error_n;
        worst.tension_seed = seed;
    }
    if (truth.objective_error > worst.objective) {
        worst.objective = truth.objective_error;
        worst.objective_seed = seed;
    }
    if (solution.iterations > worst.iterations) {
        worst.iterations = solution.iterations;
        worst.iterations_seed = seed;
    }
    worst.iteration_sum += solution.iterations;
    ++worst.cases;
    const bool good = truth.certified && solution.status == Status::ok &&
                      truth.bound_violation_n <= 0.0 &&
                      truth.tension_error_n <= kTensionTolerance_n &&
                      truth.objective_error <= kObjectiveTolerance;
    if (!good) {
        ++worst.failures;
        std::printf("FAIL seed %llu: %s, certified %d, tau error %.3g N, objective error %.3g, "
                    "bounds missed by %.3g N\n",
                    seed, describe(solution.status), truth.certified, truth.tension_error_n,
                    truth.objective_error, truth.bound_violation_n);
    }
    return good;
}

} // namespace

int main(int argc, char **argv) {
    unsigned long long cases = 20000;
    unsigned long long seed = 1;
    for (int i = 1; i < argc; i += 2) {
        char *end = nullptr;
        const unsigned long long value = i + 1 < argc ? std::strtoull(argv[i + 1], &end, 10) : 0;
        const bool number = end != nullptr && *end == '\0' && end != argv[i + 1];
        if (number && std::strcmp(argv[i], "--cases") == 0 && value > 0) {
            cases = value;
        } else if (number && std::strcmp(argv[i], "--seed") == 0) {
            seed = value;
        } else {
            std::fprintf(stderr, "usage: stress_tension [--cases N>0] [--seed S]\n");
            return 2;
        }
    }
    std::map<std::string, Worst> kinds;
    for (unsigned long long i = 0; i < cases; ++i) {
        const test::NamedProblem named = test::random_problem(seed + i);
        Worst &worst = kinds[named.kind];
        check(named.problem, nullptr, seed + i, worst);
        test::Random random(~(seed + i));
        ActiveSet guess{}; // any: a wrong guess may cost time only
        for (StringBound &bound : guess) {
            bound = static_cast<StringBound>(random.below(3));
        }
        check(named.problem, &guess, seed + i, worst);
    }
    long failures = 0;
    std::printf("%-17s %8s %9s  %-11s %-10s  %-9s %-10s  %s\n", "kind", "solves", "failures",
                "tau err N", "seed", "obj err", "seed", "factorisations mean, max (seed)");
    for (const auto &[kind, w] : kinds) {
        failures += w.failures;
        std::printf("%-17s %8ld %9ld  %-11.3g %-10llu  %-9.2g %-10llu  %.2f, %d (%llu)\n",
                    kind.c_str(), w.cases, w.failures, w.tension_n, w.tension_seed, w.objective,
                    w.objective_seed,
                    static_cast<double>(w.iteration_sum) / static_cast<double>(w.cases),
                    w.iterations, w.iterations_seed);
    }
    std::printf(
        "stress_tension: %llu problems from seed %llu, cold and from a wrong guess: %ld failures\n",
        cases, seed, failures);
    return failures == 0 ? 0 : 1;
}
