// TensionSolver: the three regularising terms, bounds, flags and memory of the servo loop's solver.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/tension/tension_solver.h"
#include "support/problem_generator.h"

using namespace spidar;

namespace {

constexpr std::size_t kStrings = 8;
constexpr std::size_t kDofs = 7;

WrenchMatrix matrix_at(const GripPose &pose) {
    return wrench_matrix(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry{}, pose);
}

WrenchMatrix matrix_at_rest() {
    return matrix_at(rest_pose(GripGeometry{}));
}

TensionSolver solver_with(const TensionSettings &settings) {
    TensionSolver solver;
    REQUIRE(solver.configure(settings) == Status::ok);
    return solver;
}

double largest_difference(const StringArray &a, const StringArray &b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < kStrings; ++i) {
        largest = std::max(largest, std::abs(a[i] - b[i]));
    }
    return largest;
}

PaperWrench error_of(const WrenchMatrix &matrix, const StringArray &tensions_n,
                     const PaperWrench &wrench) {
    PaperWrench error = apply(matrix, tensions_n);
    for (std::size_t k = 0; k < kDofs; ++k) {
        error[k] -= wrench[k];
    }
    return error;
}

bool within(const TensionSettings &settings, const StringArray &tensions_n) {
    return std::all_of(tensions_n.begin(), tensions_n.end(), [&settings](double t) {
        return t >= settings.min_tension_n && t <= settings.max_tension_n;
    });
}

// Ticks until the change term has died out.
TensionResult settled(TensionSolver &solver, const WrenchMatrix &matrix,
                      const PaperWrench &wrench) {
    TensionResult result;
    for (int tick = 0; tick < 12000 && !result.skipped; ++tick) {
        result = solver.update(matrix, wrench);
    }
    return result;
}

// A pose near the centre where a small wrench meets no bound.
GripPose central_pose(test::Random &random) {
    GripPose pose = rest_pose(GripGeometry{});
    for (int axis = 0; axis < 3; ++axis) {
        pose.position_m[axis] = random.uniform(-0.03, 0.03);
    }
    const double turn = random.uniform(-0.2, 0.2);
    const double d = kPaperPoleHalfLength_m;
    pose.r1_m = Vec3(-std::sin(turn) * d, std::cos(turn) * d, 0.0);
    const double other = turn + random.uniform(-0.2, 0.2);
    pose.r2_m = Vec3(std::cos(other) * d, std::sin(other) * d, 0.0);
    return pose;
}

struct Path {
    GripPose pose;
    PaperWrench wrench{};
};

// A smooth motion with a changing wrench, `reach` metres to each side.
Path path_at(double t, double reach_m) {
    const double d = kPaperPoleHalfLength_m;
    Path at;
    at.pose.position_m =
        reach_m * Vec3(std::sin(2.1 * t), 0.8 * std::sin(3.3 * t), 0.8 * std::cos(t));
    at.pose.r1_m = Vec3(-std::sin(t) * d, std::cos(t) * d, 0.0);
    at.pose.r2_m = Vec3(std::cos(t + 0.3) * d, std::sin(t + 0.3) * d, 0.0);
    at.wrench = {3.0 * std::sin(5.0 * t), 2.0, -1.0, 0.05 * std::cos(4.0 * t), 0.0, 0.0, 0.02};
    return at;
}

} // namespace

TEST_CASE("tension solver: zero wrench at the centre gives the reference tension in every string") {
    TensionSolver solver = solver_with({});
    const TensionResult result = solver.update(matrix_at_rest(), PaperWrench{});
    const TensionSettings &s = solver.settings();
    // At rest A (1,...,1) = 0, so that the terms decide alone: ridge pulls the reference towards zero.
    const double expected =
        s.reference_weight * s.reference_tension_n / (s.reference_weight + s.ridge);
    CHECK(result.status == Status::ok);
    CHECK(expected == doctest::Approx(s.reference_tension_n).epsilon(1e-4));
    for (std::size_t i = 0; i < kStrings; ++i) {
        CHECK(std::abs(result.tensions_n[i] - expected) < 1e-12);
    }
    for (std::size_t k = 0; k < kDofs; ++k) {
        CHECK(std::abs(apply(matrix_at_rest(), result.tensions_n)[k]) < 1e-13);
    }
}

TEST_CASE("tension solver: masks name the strings at bounds") {
    test::Random random(11);
    TensionSolver solver = solver_with({});
    int bounds = 0;
    for (int round = 0; round < 300; ++round) {
        const WrenchMatrix matrix =
            matrix_at(test::random_pose(random, 0.15, random.uniform(0.7, 2.4)));
        PaperWrench wrench{};
        for (std::size_t k = 0; k < kDofs; ++k) {
            wrench[k] = random.uniform(-4.0, 4.0) * (k < 3 ? 1.0 : 0.04);
        }
        const TensionResult result = solver.update(matrix, wrench);
        CAPTURE(round);
        CHECK(usable(result.status));
        CHECK(within(solver.settings(), result.tensions_n));
        for (std::size_t i = 0; i < kStrings; ++i) {
            const bool low = ((result.at_min_mask >> i) & 1) != 0;
            const bool high = ((result.at_max_mask >> i) & 1) != 0;
            CHECK(low == (result.tensions_n[i] == solver.settings().min_tension_n));
            CHECK(high == (result.tensions_n[i] == solver.settings().max_tension_n));
            bounds += low || high ? 1 : 0;
        }
    }
    CHECK(bounds > 100);
}

TEST_CASE("tension solver: a direction that no string can give is flagged") {
    // Parallel poles: g about their common normal is lost.
    GripPose pose = rest_pose(GripGeometry{});
    pose.r2_m = pose.r1_m;
    TensionSolver solver = solver_with({});
    PaperWrench wrench{};
    wrench[6] = 0.05;
    const TensionResult result = solver.update(matrix_at(pose), wrench);
    CHECK(result.status == Status::wrench_limited);
    CHECK(apply(matrix_at(pose), result.tensions_n)[6] == doctest::Approx(0.0));
    CHECK(within(solver.settings(), result.tensions_n));
}

TEST_CASE("tension solver: a broken string carries nothing and the rest still meet the wrench") {
    for (std::size_t dead = 0; dead < kStrings; ++dead) {
        TensionSettings settings;
        settings.broken_mask = static_cast<std::uint8_t>(1U << dead);
        TensionSolver solver = solver_with(settings);
        const TensionResult result = solver.update(matrix_at_rest(), {0.5, 0.0, 0.0, 0, 0, 0, 0});
        CAPTURE(dead);
        CHECK(usable(result.status));
        CHECK(result.tensions_n[dead] == 0.0);
        CHECK(((result.at_min_mask >> dead) & 1) == 0);
        for (std::size_t i = 0; i < kStrings; ++i) {
            if (i != dead) {
                CHECK(result.tensions_n[i] >= settings.min_tension_n);
            }
        }
    }
    TensionSettings settings;
    settings.broken_mask = 0xFF;
    TensionSolver none = solver_with(settings);
    const TensionResult result = none.update(matrix_at_rest(), {1.0, 0, 0, 0, 0, 0, 0});
    CHECK(result.tensions_n == StringArray{});
    CHECK(result.status == Status::wrench_limited);
}

TEST_CASE("tension solver: a wrench beyond reach saturates, says so and keeps its sign") {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        TensionSolver solver = solver_with({});
        PaperWrench wrench{};
        wrench[axis] = 100.0;
        const TensionResult result = solver.update(matrix_at_rest(), wrench);
        CAPTURE(axis);
        CHECK(result.status == Status::wrench_limited);
        CHECK(result.at_max_mask != 0);
        CHECK(within(solver.settings(), result.tensions_n));
        const double achieved_n = apply(matrix_at_rest(), result.tensions_n)[axis];
        CHECK(achieved_n > 1.0);
        CHECK(achieved_n < 100.0);
    }
}

TEST_CASE("tension solver: the change term limits jumps along a path outside wrench closure") {
    double jumps[2] = {};
    double errors[2] = {};
    for (int on = 0; on < 2; ++on) {
        TensionSettings settings;
        settings.reference_weight = 1e-6;
        settings.change_weight = on == 1 ? 1e-2 : 0.0;
        TensionSolver solver = solver_with(settings);
        StringArray last{};
        for (int tick = 0; tick < 4000; ++tick) {
            const Path at = path_at(0.001 * tick, 0.15);
            const WrenchMatrix matrix = matrix_at(at.pose);
            const TensionResult result = solver.update(matrix, at.wrench);
            const PaperWrench error = error_of(matrix, result.tensions_n, at.wrench);
            if (tick > 0) {
                jumps[on] = std::max(jumps[on], largest_difference(result.tensions_n, last));
            }
            for (std::size_t k = 0; k < 3; ++k) {
                errors[on] += error[k] * error[k];
            }
            last = result.tensions_n;
        }
    }
    CHECK(jumps[0] > 0.05); // there was something to limit
    CHECK(jumps[1] < 0.5 * jumps[0]);
    CHECK(errors[1] < 1.05 * errors[0]); // and the wrench hardly pays for it
}

TEST_CASE("tension solver: the change term has no steady cost and refers to what was sent") {
    const WrenchMatrix matrix = matrix_at_rest();
    const PaperWrench wrench{0.0, 0.0, -3.0, 0, 0, 0, 0};
    StringArray ends[2];
    for (int on = 0; on < 2; ++on) {
        TensionSettings settings;
        settings.change_weight = on == 1 ? 1e-2 : 0.0;
        TensionSolver solver = solver_with(settings);
        settled(solver, matrix, {0.0, 0.0, 3.0, 0, 0, 0, 0});
        ends[on] = settled(solver, matrix, wrench).tensions_n;
    }
    CHECK(largest_difference(ends[0], ends[1]) < 1e-6);

    TensionSettings settings;
    settings.change_weight = 100.0; // stay where the strings are
    TensionSolver solver = solver_with(settings);
    StringArray sent{};
    sent.fill(4.0);
    solver.set_last_tensions(sent);
    CHECK(largest_difference(solver.update(matrix, PaperWrench{}).tensions_n, sent) < 1e-3);
    StringArray broken = sent;
    broken[2] = std::nan("");
    solver.set_last_tensions(broken); // ignored
    CHECK(largest_difference(solver.update(matrix, PaperWrench{}).tensions_n, sent) < 1e-3);
    solver.reset();
    CHECK(largest_difference(solver.update(matrix, PaperWrench{}).tensions_n, sent) > 3.0);
}

TEST_CASE("tension solver: a wrench that is not finite counts as zero, and the matrix is refused") {
    TensionSolver at_work = solver_with({});
    const PaperWrench wrench_of_work{1.0, 0, 0, 0, 0, 0, 0};
    const TensionResult good = settled(at_work, matrix_at_rest(), wrench_of_work);
    const double bad_values[] = {std::nan(""), HUGE_VAL, -HUGE_VAL};
    for (const double bad : bad_values) {
        for (std::size_t k = 0; k < kDofs; ++k) {
            TensionSolver solver = solver_with({});
            TensionSolver zero = solver_with({});
            PaperWrench wrench{};
            wrench[k] = bad;
            const TensionResult result = solver.update(matrix_at_rest(), wrench);
            CHECK(result.status == Status::not_finite);
            CHECK(result.tensions_n == zero.update(matrix_at_rest(), PaperWrench{}).tensions_n);
        }
        for (std::size_t i = 0; i < kStrings; ++i) {
            for (std::size_t k = 0; k < kDofs; ++k) {
                TensionSolver solver = at_work; // with its memory
                WrenchMatrix matrix = matrix_at_rest();
                matrix.columns[i][k] = bad;
                const TensionResult refused = solver.update(matrix, wrench_of_work);
                CHECK(refused.status == Status::not_finite);
                for (double tension : refused.tensions_n) {
                    CHECK(tension == solver.settings().min_tension_n);
                }
                // Memory stands: the next good tick goes on from the last good one.
                CHECK(largest_difference(solver.update(matrix_at_rest(), wrench_of_work).tensions_n,
                                         good.tensions_n) < 1e-9);
            }
        }
    }
}

TEST_CASE("tension solver: impossible settings are named and refused; the old ones stand") {
    CHECK(validate(TensionSettings{}).empty());
    struct Slip {
        double TensionSettings::*field;
        double value;
        const char *word;
    };
    const Slip slips[] = {{&TensionSettings::min_tension_n, -0.1, "min_tension_n"},
                          {&TensionSettings::min_tension_n, 20.0, "max_tension_n"},
                          {&TensionSettings::max_tension_n, 0.3, "max_tension_n"},
                          {&TensionSettings::reference_tension_n, 0.1, "reference_tension_n"},
                          {&TensionSettings::reference_tension_n, 11.0, "reference_tension_n"},
                          {&TensionSettings::weight_force, 0.0, "weight_force"},
                          {&TensionSettings::weight_moment_per_m, -1.0, "weight_moment_per_m"},
                          {&TensionSettings::weight_grasp_per_m, 1e12, "weight_grasp_per_m"},
                          {&TensionSettings::reference_weight, -1e-4, "reference_weight"},
                          {&TensionSettings::change_weight, -1.0, "change_weight"}};
    TensionSolver solver = solver_with({});
    const auto refuse = [&solver](const TensionSettings &settings, const char *word) {
        const std::string sentence = validate(settings);
        CAPTURE(sentence);
        CHECK(sentence.find(word) != std::string::npos);
        CHECK(solver.configure(settings) == Status::invalid_settings);
        CHECK(solver.settings().max_tension_n == TensionSettings{}.max_tension_n);
    };
    for (const Slip &slip : slips) {
        TensionSettings settings;
        settings.*slip.field = slip.value;
        refuse(settings, slip.word);
        settings.*slip.field = std::nan("");
        refuse(settings, "nan");
        settings.*slip.field = HUGE_VAL;
        refuse(settings, "inf");
    }
    TensionSettings settings;
    settings.ridge = 0.0;
    settings.reference_weight = 0.0;
    refuse(settings, "ridge");
}

TEST_CASE("tension solver: warm along a path equals cold at every tick") {
    TensionSettings settings;
    settings.change_weight = 0.0; // the only memory left is the active set
    TensionSolver warm = solver_with(settings);
    int changes = 0;
    std::uint8_t last_mask = 0;
    for (int tick = 0; tick < 3000; ++tick) {
        const Path at = path_at(0.001 * tick, 0.12);
        const TensionResult result = warm.update(matrix_at(at.pose), at.wrench);
        TensionSolver cold = solver_with(settings);
        const TensionResult fresh = cold.update(matrix_at(at.pose), at.wrench);
        CAPTURE(tick);
        CHECK(largest_difference(result.tensions_n, fresh.tensions_n) < 1e-10);
        CHECK(result.at_min_mask == fresh.at_min_mask);
        changes += result.at_min_mask != last_mask ? 1 : 0;
        last_mask = result.at_min_mask;
    }
    CHECK(changes > 5);
}

TEST_CASE(
    "tension solver: wrench_limited is told where bounds cost wrench, not where the terms do") {
    // Truth: the same problem without bounds, by the safe search; what that misses the terms cost.
    test::Random random(17);
    TensionSettings settings;
    settings.change_weight = 0.0;
    int limited = 0;
    int free = 0;
    for (int round = 0; round < 2000; ++round) {
        TensionSolver solver = solver_with(settings);
        const WrenchMatrix matrix =
            matrix_at(round % 2 == 0 ? central_pose(random)
                                     : test::random_pose(random, 0.1, random.uniform(0.9, 2.2)));
        const double size = random.uniform(0.05, 2.0);
        PaperWrench wrench{};
        for (std::size_t k = 0; k < kDofs; ++k) {
            wrench[k] = random.uniform(-size, size) * (k < 3 ? 1.0 : 0.04);
        }
        const TensionResult result = solver.update(matrix, wrench);
        TensionProblem open;
        open.matrix = matrix;
        open.wrench = wrench;
        open.weights = tension_weights(settings);
        open.proximal_weight = settings.ridge + settings.reference_weight;
        open.proximal_target_n.fill(settings.reference_weight * settings.reference_tension_n /
                                    open.proximal_weight);
        open.lower_n.fill(-1e6);
        open.upper_n.fill(1e6);
        const double open_n = solve_exactly(open, nullptr).largest_error_n;
        const PaperWrench error = error_of(matrix, result.tensions_n, wrench);
        double bounded_n = 0.0;
        for (std::size_t k = 0; k < kDofs; ++k) {
            bounded_n = std::max(bounded_n, std::abs(open.weights[k] * error[k]));
        }
        CAPTURE(round);
        CAPTURE(open_n);
        CAPTURE(bounded_n);
        if (bounded_n > open_n + 0.05) {
            CHECK(result.status == Status::wrench_limited);
            ++limited;
        } else if (result.at_min_mask == 0 && result.at_max_mask == 0 && open_n < 1.0) {
            CHECK(result.status == Status::ok);
            ++free;
        }
    }
    CHECK(limited > 100);
    CHECK(free > 100);
}

TEST_CASE("tension solver: an unchanged tick that has settled is skipped, bit for bit") {
    test::Random random(23);
    long skipped = 0;
    long solved = 0;
    for (int round = 0; round < 200; ++round) {
        TensionSettings settings;
        settings.change_weight = random.chance(0.2) ? 0.0 : 1e-2;
        settings.broken_mask = random.chance(0.2) ? 4 : 0;
        settings.dof_mask = random.chance(0.2) ? kTranslationOnly : kAllDofs;
        TensionSolver solver = solver_with(settings);
        WrenchMatrix matrix = matrix_at(central_pose(random));
        PaperWrench wrench{};
        for (int tick = 0; tick < 600; ++tick) {
            if (random.chance(0.01)) {
                matrix = matrix_at(test::random_pose(random, 0.1, 1.5));
            }
            if (random.chance(0.01)) {
                const double size = random.chance(0.3) ? 0.0 : random.chance(0.2) ? 50.0 : 2.0;
                for (std::size_t k = 0; k < kDofs; ++k) {
                    wrench[k] = random.uniform(-size, size) * (k < 3 ? 1.0 : 0.04);
                }
            }
            if (random.chance(0.01)) { // a slew limit was at work
                StringArray sent{};
                for (double &tension : sent) {
                    tension = random.uniform(0.3, 3.0);
                }
                solver.set_last_tensions(sent);
            }
            // The same state, made to forget that nothing changed: a step back and forth of the memory.
            TensionSolver unskipped = solver;
            unskipped.forget_settled();
            const TensionResult truth = unskipped.update(matrix, wrench);
            const TensionResult result = solver.update(matrix, wrench);
            REQUIRE_FALSE(truth.skipped);
            REQUIRE(result.tensions_n == truth.tensions_n);
            REQUIRE(result.at_min_mask == truth.at_min_mask);
            REQUIRE(result.at_max_mask == truth.at_max_mask);
            REQUIRE(result.status == truth.status);
            (result.skipped ? skipped : solved) += 1;
        }
    }
    CHECK(skipped > 10000);
    CHECK(solved > 10000);
}
