#include "bench/bench_tension.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/library_peers.h"
#include "bench/repeated_times.h"
#include "bench/tension_peers.h"
#include "bench/tension_sets.h"
#include "support/exact_optimum.h"

namespace spidar::bench {

namespace {

// A tension further from the optimum than this is a failure, whatever the method says of itself.
constexpr double kWrong_n = 1e-3;

struct Record {
    explicit Record(std::size_t problems) : times(problems) {}
    RepeatedTimes times;
    double worst_n = 0.0;
    long failures = 0;
};

void include_error(Record &record, const TensionProblem &problem, bool solved,
                   const StringArray &tensions_n, const StringArray &exact_n) {
    double error = 0.0;
    bool in_bounds = true;
    for (std::size_t i = 0; i < exact_n.size(); ++i) {
        const double away = std::abs(tensions_n[i] - exact_n[i]);
        error = away <= error ? error : std::isnan(away) ? HUGE_VAL : away;
        in_bounds = in_bounds && tensions_n[i] >= problem.lower_n[i] - kWrong_n &&
                    tensions_n[i] <= problem.upper_n[i] + kWrong_n;
    }
    record.worst_n = std::max(record.worst_n, error);
    record.failures += solved && in_bounds && error <= kWrong_n ? 0 : 1;
}

bool is_ours(const std::string &name) {
    return name.rfind("ours", 0) == 0;
}

long run_set(const TensionSet &set, const std::vector<StringArray> &exact, bool warm,
             std::vector<std::unique_ptr<TensionMethod>> &methods, std::vector<BenchRow> &rows) {
    std::vector<Record> records(methods.size(), Record(set.problems.size()));
    in_turns(set.problems.size(), methods.size(), [&](int run, std::size_t m, std::size_t p) {
        StringArray tensions{};
        bool solved = false;
        records[m].times.time(
            p, [&] { solved = methods[m]->solve(set.problems[p], warm && p > 0, tensions); });
        if (run == 0) {
            include_error(records[m], set.problems[p], solved, tensions, exact[p]);
        }
    });
    const std::size_t first_row = rows.size();
    double daqp_ns = HUGE_VAL;
    long our_failures = 0;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        BenchRow row;
        row.method = methods[m]->name();
        row.set = set.name;
        row.mode = warm ? "warm" : "cold";
        records[m].times.fill(row);
        row.worst_error = records[m].worst_n;
        row.failures = records[m].failures;
        if (is_daqp(row.method)) {
            daqp_ns = std::min(daqp_ns, row.median_ns);
        }
        our_failures += is_ours(row.method) ? row.failures : 0;
        rows.push_back(row);
    }
    for (std::size_t r = first_row; r < rows.size(); ++r) {
        rows[r].ratio_to_daqp = std::isfinite(daqp_ns) ? rows[r].median_ns / daqp_ns : kNoFigure;
        print_row(rows[r]);
    }
    return our_failures;
}

} // namespace

int bench_tension(std::vector<BenchRow> &rows) {
    std::vector<std::unique_ptr<TensionMethod>> methods = tension_methods();
    print_header("tension solvers; ratios to the fastest DAQP of the same set and mode");
    long failures = 0;
    for (const TensionSet &set : tension_sets()) {
        std::vector<StringArray> exact;
        for (const TensionProblem &problem : set.problems) {
            const test::Certificate truth =
                test::certify(problem, solve_exactly(problem, nullptr).tensions_n);
            failures += truth.certified ? 0 : 1;
            exact.push_back(truth.exact_n);
        }
        if (set.smooth) {
            failures += run_set(set, exact, true, methods, rows);
        }
        failures += run_set(set, exact, false, methods, rows);
    }
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::bench
