#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "device/contact/god_object.h"

using namespace spidar;

namespace {

using Rows = std::array<ConstraintRow, kMaxConstraints>;

std::array<double, 8> move_of(const Rows &rows, const GodObjectSolution &solution, int count) {
    std::array<double, 8> move{};
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        for (std::size_t j = 0; j < move.size(); ++j) {
            move[j] += solution.push[k] * rows[k].row[j];
        }
    }
    return move;
}

Rows random_rows(std::mt19937_64 &random, int count) {
    std::normal_distribution<double> normal;
    Rows rows{};
    for (int i = 0; i < count; ++i) {
        ConstraintRow &row = rows[static_cast<std::size_t>(i)];
        if (i > 0 && random() % 4 == 0) {
            row = rows[random() % static_cast<std::size_t>(i)]; // the same again
        } else {
            for (std::size_t k = 0; k < 7; ++k) {
                row.row[k] = random() % 3 == 0 ? 0.0 : normal(random);
            }
            row.row[random() % 7] += 1.0;
        }
        row.depth = 0.01 * normal(random);
    }
    return rows;
}

} // namespace

TEST_CASE("god-object: the optimality conditions hold on random sets, whatever the first guess") {
    std::mt19937_64 random(5);
    int pushing = 0;
    for (int round = 0; round < 20000; ++round) {
        const int count = 1 + static_cast<int>(random() % 8);
        const Rows rows = random_rows(random, count);
        const GodObjectSolution solution =
            solve_god_object(rows, count, static_cast<std::uint8_t>(random()));
        const std::array<double, 8> move = move_of(rows, solution, count);
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            double reached = 0.0;
            double size = 0.0;
            for (std::size_t j = 0; j < move.size(); ++j) {
                reached += rows[k].row[j] * move[j];
                size += rows[k].row[j] * rows[k].row[j];
            }
            const double slack = reached - rows[k].depth;
            // Regularisation leaves a constraint short by 1e-11 of what it pushes.
            const double tolerance = 1e-9 * (0.05 + size * solution.push[k]);
            REQUIRE(solution.push[k] >= 0.0);
            REQUIRE(slack > -tolerance);
            REQUIRE((solution.push[k] == 0.0 || std::abs(slack) < tolerance));
            pushing += solution.push[k] > 0.0 ? 1 : 0;
        }
    }
    CHECK(pushing > 10000);
}

TEST_CASE("god-object: equal constraints share equally; nothing broken costs no solve") {
    Rows rows{};
    for (ConstraintRow &row : rows) {
        row.row[2] = 0.05;
        row.depth = 0.004;
    }
    const GodObjectSolution shared = solve_god_object(rows, 8, 0);
    for (const double push : shared.push) {
        CHECK(push == doctest::Approx(0.004 / (8 * 0.05 * 0.05)).epsilon(1e-3));
    }
    for (ConstraintRow &row : rows) {
        row.depth = -0.001;
    }
    const GodObjectSolution free = solve_god_object(rows, 8, 0xFF);
    CHECK(free.solves == 0);
    CHECK(free.active_mask == 0);
}

TEST_CASE("god-object: the last active set as a guess needs one solve") {
    std::mt19937_64 random(9);
    int more = 0;
    for (int round = 0; round < 500; ++round) {
        Rows rows = random_rows(random, 4);
        const GodObjectSolution first = solve_god_object(rows, 4, 0);
        for (ConstraintRow &row : rows) {
            row.depth *= 1.0 + 1e-9;
        }
        const GodObjectSolution second = solve_god_object(rows, 4, first.active_mask);
        more += second.solves > 1 ? 1 : 0;
    }
    CHECK(more < 25); // sets in which equal rows change places
}

TEST_CASE("god-object: not finite input gives no push") {
    const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(), 1e300};
    for (const double value : odd) {
        Rows rows{};
        rows[0].row[0] = 1.0;
        rows[0].depth = 0.01;
        rows[1].row[1] = value;
        rows[1].depth = 0.01;
        for (const double push : solve_god_object(rows, 2, 0).push) {
            CHECK(push == 0.0);
        }
    }
}
