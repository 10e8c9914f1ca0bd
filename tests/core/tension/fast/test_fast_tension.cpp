// The fast path: what it certifies is the optimum, at each SIMD level, and it answers nearly always. DOF masks.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/simd_level.h"
#include "core/tension/fast/fast_tension.h"
#include "core/tension/tension_solver.h"
#include "support/exact_optimum.h"
#include "support/problem_generator.h"

using namespace spidar;

namespace {

constexpr SimdLevel kLevels[] = {SimdLevel::plain, SimdLevel::avx2};

// The levels that this processor runs.
std::vector<SimdLevel> levels() {
    std::vector<SimdLevel> supported;
    std::copy_if(std::begin(kLevels), std::end(kLevels), std::back_inserter(supported), supports);
    return supported;
}

} // namespace

TEST_CASE("simd level: a setting of each solver, refused where the processor lacks it") {
    CHECK(supports(SimdLevel::plain)); // runs everywhere
    CHECK(supports(best_simd_level()));
    CHECK(TensionSettings{}.simd == best_simd_level());
    for (const SimdLevel level : kLevels) {
        TensionSettings settings;
        settings.simd = level;
        CHECK((TensionSolver{}.configure(settings) == Status::ok) == supports(level));
        CHECK(describe(level)[0] != '\0');
    }
    for (const int unknown : {2, 99}) { // 2 was AVX-512
        TensionSettings settings;
        settings.simd = static_cast<SimdLevel>(unknown);
        CHECK_FALSE(supports(settings.simd));
        CHECK(validate(settings).find("simd") != std::string::npos);
        CHECK(TensionSolver{}.configure(settings) == Status::invalid_settings);
        CHECK(std::string(describe(settings.simd)) == "unknown vectors");
    }
}

TEST_CASE(
    "simd level: two solvers at two levels, turn by turn in one process, disturb each other in "
    "no bit") {
    const auto answers_of = [](TensionSolver &solver, int i) {
        const TensionProblem problem =
            test::random_problem(95000U + static_cast<std::uint64_t>(i)).problem;
        return solver.update(problem.matrix, problem.wrench).tensions_n;
    };
    constexpr int kTicks = 300;
    std::vector<std::vector<StringArray>> alone;
    std::vector<TensionSolver> solvers;
    for (const SimdLevel level : levels()) {
        TensionSettings settings;
        settings.simd = level;
        TensionSolver solver;
        REQUIRE(solver.configure(settings) == Status::ok);
        solvers.push_back(solver);
        auto &answers = alone.emplace_back();
        for (int i = 0; i < kTicks; ++i) {
            answers.push_back(answers_of(solver, i));
        }
    }
    for (int i = 0; i < kTicks; ++i) {
        for (std::size_t k = 0; k < solvers.size(); ++k) {
            CHECK(answers_of(solvers[k], i) == alone[k][static_cast<std::size_t>(i)]);
        }
    }
    // The levels are told apart by their last bits: else this test would show nothing.
    CHECK((solvers.size() == 1 || alone.front() != alone.back()));
}

TEST_CASE("fast tension: what it certifies is optimal in quad precision, at every level") {
    for (const SimdLevel level : levels()) {
        int answered = 0;
        int easy = 0;
        for (std::uint64_t seed = 90000; seed < 91500; ++seed) {
            const test::NamedProblem named = test::random_problem(seed);
            TensionSolution solution;
            const bool is_easy = (named.kind == "central" || named.kind == "strong") &&
                                 named.problem.proximal_weight > 1e-7;
            easy += is_easy ? 1 : 0;
            if (!solve_fast(FastInput::of(named.problem), nullptr, level, solution)) {
                continue;
            }
            answered += is_easy ? 1 : 0;
            const test::Certificate truth = test::certify(named.problem, solution.tensions_n);
            CAPTURE(seed);
            REQUIRE(truth.certified);
            CHECK(truth.tension_error_n < 1e-10);
            CHECK(truth.bound_violation_n == 0.0);
            CHECK(truth.objective_error < 1e-12);
            for (std::size_t i = 0; i < solution.active.size(); ++i) {
                const bool low = solution.active[i] == StringBound::at_lower;
                const bool high = solution.active[i] == StringBound::at_upper;
                CHECK((!low || solution.tensions_n[i] == named.problem.lower_n[i]));
                CHECK((!high || solution.tensions_n[i] == named.problem.upper_n[i]));
            }
        }
        CHECK(easy > 100);
        CHECK(answered > easy * 95 / 100); // it is no fast way to nowhere
    }
}

TEST_CASE("fast tension: both levels and the safe search agree") {
    for (std::uint64_t seed = 92000; seed < 92300; ++seed) {
        TensionProblem problem = test::random_problem(seed).problem;
        problem.proximal_weight = 1e-4;
        const TensionSolution safe = solve_exactly(problem, nullptr);
        for (const SimdLevel level : levels()) {
            const TensionSolution fast = solve_tension_problem(problem, &safe.active, level);
            CAPTURE(seed);
            for (std::size_t i = 0; i < fast.tensions_n.size(); ++i) {
                CHECK(std::abs(fast.tensions_n[i] - safe.tensions_n[i]) < 1e-11);
            }
        }
    }
}

TEST_CASE("fast tension: a pivot that cancelled is no convergence (found by stress_tension)") {
    // 9919: weight 1e-12, all strings free: the table was wrong by 1e8 along the null vector and the corrections stood
    // still there, 10 N from the optimum.
    const TensionProblem problem = test::random_problem(9919).problem;
    test::Random random(~std::uint64_t{9919});
    ActiveSet guess{};
    for (StringBound &bound : guess) {
        bound = static_cast<StringBound>(random.below(3));
    }
    const TensionSolution solution = solve_tension_problem(problem, &guess);
    CHECK(test::certify(problem, solution.tensions_n).tension_error_n < 1e-9);
}

TEST_CASE("fast tension: a string held and released again leaves the table symmetric (found by "
          "stress_tension_quick)") {
    // Releasing a stiff string took its column of the table from a difference that was rounding alone at this scale:
    // a correction with that table then spoilt the tensions and ended there.
    for (const SimdLevel level : levels()) {
        int answered = 0;
        for (std::uint64_t seed = 93000; seed < 103000; ++seed) {
            test::NamedProblem named = test::random_problem(seed);
            if (named.kind.find("rank_lost") != std::string::npos) {
                continue; // at this scale the rounding of a gradient alone moves these
            }
            TensionProblem &problem = named.problem;
            problem.proximal_weight = 0.1;
            test::Random random(~seed);
            const double scale = std::pow(10.0, random.uniform(3.0, 5.5));
            for (PaperWrench &column : problem.matrix.columns) {
                for (double &value : column) {
                    value *= scale;
                }
            }
            TensionSolution fast;
            if (!solve_fast(FastInput::of(problem), nullptr, level, fast)) {
                continue;
            }
            ++answered;
            const TensionSolution safe = solve_exactly(problem, nullptr);
            CAPTURE(seed);
            for (std::size_t i = 0; i < fast.tensions_n.size(); ++i) {
                CHECK(std::abs(fast.tensions_n[i] - safe.tensions_n[i]) < 1e-11);
            }
        }
        CHECK(answered > 1000);
    }
}

TEST_CASE("DOF mask: a far bound guessed wrongly leaves no rounding behind (found by "
          "stress_tension_quick)") {
    for (const SimdLevel level : levels()) {
        for (std::uint64_t seed = 110000; seed < 110200; ++seed) {
            TensionProblem problem = test::random_problem(seed).problem;
            problem.weights = {1, 1, 1, 0, 0, 0, 0};
            problem.proximal_weight = 1e-3;
            problem.lower_n[4] = -9e11;
            const ActiveSet guess = {StringBound::free, StringBound::free, StringBound::free,
                                     StringBound::free, StringBound::at_lower};
            const StringArray given = solve_tension_problem(problem, &guess, level).tensions_n;
            const StringArray safe = solve_exactly(problem, nullptr).tensions_n;
            CAPTURE(seed);
            for (std::size_t i = 0; i < given.size(); ++i) {
                CHECK(std::abs(given[i] - safe[i]) < 1e-10);
            }
        }
    }
}

TEST_CASE(
    "DOF mask: translation alone is answered the fast way nearly always, by the exact answer") {
    for (const SimdLevel level : levels()) {
        int answered = 0;
        constexpr std::uint64_t kProblems = 400;
        for (std::uint64_t seed = 120000; seed < 120000 + kProblems; ++seed) {
            TensionProblem problem = test::random_problem(seed).problem;
            problem.weights = {1, 1, 1, 0, 0, 0, 0};
            problem.proximal_weight = 1e-3;
            TensionSolution fast;
            if (!solve_fast(FastInput::of(problem), nullptr, level, fast)) {
                continue;
            }
            ++answered;
            const StringArray safe = solve_exactly(problem, nullptr).tensions_n;
            CAPTURE(seed);
            for (std::size_t i = 0; i < safe.size(); ++i) {
                CHECK(std::abs(fast.tensions_n[i] - safe[i]) < 1e-10);
            }
        }
        CHECK(answered > static_cast<int>(kProblems) * 80 / 100); // 15 % are made to be hard
    }
}

TEST_CASE("DOF mask: what is left out weighs nothing, what remains is met") {
    test::Random random(31);
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    for (const std::uint8_t mask : {kTranslationOnly, kNoGrasp, kAllDofs}) {
        TensionSettings settings;
        settings.dof_mask = mask;
        settings.change_weight = 0.0;
        TensionSolver solver;
        REQUIRE(solver.configure(settings) == Status::ok);
        for (int i = 0; i < 100; ++i) {
            GripPose pose = rest_pose(GripGeometry{});
            pose.position_m = Vec3(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                                   random.uniform(-0.05, 0.05));
            const WrenchMatrix matrix = wrench_matrix(frame, GripGeometry{}, pose);
            PaperWrench wrench{};
            for (std::size_t k = 0; k < wrench.size(); ++k) {
                wrench[k] = random.uniform(-1.0, 1.0) * (k < 3 ? 1.0 : 0.02);
            }
            const TensionResult result = solver.update(matrix, wrench);
            TensionProblem
                bare; // the same with the weights of the rest at zero, by the safe search
            bare.matrix = matrix;
            bare.wrench = wrench;
            for (std::size_t k = 0; k < wrench.size(); ++k) {
                const bool counts = ((static_cast<unsigned>(mask) >> k) & 1U) != 0U;
                bare.weights[k] = counts ? (k < 3 ? 1.0 : 25.0) : 0.0;
            }
            bare.proximal_weight = settings.ridge + settings.reference_weight;
            bare.proximal_target_n.fill(settings.reference_weight * settings.reference_tension_n /
                                        bare.proximal_weight);
            bare.lower_n.fill(settings.min_tension_n);
            bare.upper_n.fill(settings.max_tension_n);
            const StringArray expected = solve_exactly(bare, nullptr).tensions_n;
            CAPTURE(i);
            for (std::size_t s = 0; s < expected.size(); ++s) {
                CHECK(std::abs(result.tensions_n[s] - expected[s]) < 1e-11);
            }
        }
    }
    TensionSettings nothing;
    nothing.dof_mask = 0;
    CHECK(validate(nothing).find("dof_mask") != std::string::npos);
    nothing.dof_mask = 0x80;
    CHECK(TensionSolver{}.configure(nothing) == Status::invalid_settings);
}

TEST_CASE("DOF mask: a string that crosses from one bound to the other is no convergence (found by "
          "stress_tension_quick)") {
    // All strings saturate: none is free before or after, and only their sides change.
    test::Random random(77);
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    for (const SimdLevel level : levels()) {
        for (int round = 0; round < 300; ++round) {
            TensionProblem problem;
            problem.matrix = wrench_matrix(
                frame, GripGeometry{}, test::random_pose(random, 0.2, random.uniform(0.5, 2.5)));
            problem.weights = {1, 1, 1, 0, 0, 0, 0};
            const double size = random.chance(0.5) ? 300.0 : 10.0;
            problem.wrench = {random.uniform(-size, size), random.uniform(-size, size),
                              random.uniform(-size, size)};
            problem.proximal_weight = random.chance(0.5) ? 1e-3 : 0.2;
            problem.lower_n.fill(0.3);
            problem.upper_n.fill(random.uniform(1.5, 10.0));
            problem.proximal_target_n.fill(0.5);
            ActiveSet guess{};
            for (StringBound &bound : guess) {
                bound = static_cast<StringBound>(random.below(3));
            }
            const StringArray given = solve_tension_problem(problem, &guess, level).tensions_n;
            CAPTURE(round);
            CHECK(test::certify(problem, given).tension_error_n < 1e-11);
        }
    }
}
