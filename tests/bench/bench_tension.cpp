#include "bench/bench_tension.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "bench/tension_peers.h"
#include "bench/tension_sets.h"
#include "support/exact_optimum.h"

namespace spidar::bench {

namespace {

constexpr int kRuns = 4; // the least of them counts: it was not interrupted
// The methods take turns at this many problems: the machine's moods meet all alike, and each runs with warm caches.
constexpr std::size_t kBlock = 200;
// A tension further from the optimum than this is a failure, whatever the method says of itself.
constexpr double kWrong_n = 1e-3;

#if defined(__x86_64__)
std::uint64_t ticks() {
    __builtin_ia32_lfence();
    const std::uint64_t now = __builtin_ia32_rdtsc();
    __builtin_ia32_lfence();
    return now;
}
#else
std::uint64_t ticks() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}
#endif

double ns_per_tick() {
    const auto start = std::chrono::steady_clock::now();
    const std::uint64_t from = ticks();
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(50)) {
    }
    const std::uint64_t to = ticks();
    const std::chrono::duration<double, std::nano> passed =
        std::chrono::steady_clock::now() - start;
    return passed.count() / static_cast<double>(to - from);
}

// What the two reads of the counter cost themselves.
std::uint64_t empty_call() {
    std::uint64_t least = ~std::uint64_t{0};
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t from = ticks();
        least = std::min(least, ticks() - from);
    }
    return least;
}

struct Record {
    std::vector<std::uint64_t> ticks;
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

void time_one(const TensionProblem &problem, const StringArray &exact_n, bool warm, bool judge,
              std::size_t place, TensionMethod &method, Record &record) {
    static const std::uint64_t nothing = empty_call();
    StringArray tensions{};
    const std::uint64_t from = ticks();
    const bool solved = method.solve(problem, warm, tensions);
    const std::uint64_t spent = ticks() - from;
    record.ticks[place] = std::min(record.ticks[place], spent > nothing ? spent - nothing : 0);
    if (judge) {
        include_error(record, problem, solved, tensions, exact_n);
    }
}

double quantile(std::vector<double> &sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

bool is_daqp(const std::string &name) {
    return name.rfind("DAQP", 0) == 0;
}

bool is_ours(const std::string &name) {
    return name.rfind("ours", 0) == 0;
}

long run_set(const TensionSet &set, const std::vector<StringArray> &exact, bool warm,
             std::vector<std::unique_ptr<TensionMethod>> &methods, double tick_ns,
             std::vector<BenchRow> &rows) {
    std::vector<Record> records(methods.size());
    for (auto &record : records) {
        record.ticks.assign(set.problems.size(), ~std::uint64_t{0});
    }
    for (int run = 0; run < kRuns; ++run) {
        for (std::size_t from = 0; from < set.problems.size(); from += kBlock) {
            const std::size_t to = std::min(from + kBlock, set.problems.size());
            for (std::size_t m = 0; m < methods.size(); ++m) {
                for (std::size_t p = from; p < to; ++p) {
                    time_one(set.problems[p], exact[p], warm && p > 0, run == 0, p, *methods[m],
                             records[m]);
                }
            }
        }
    }
    const std::size_t first_row = rows.size();
    double daqp_ns = HUGE_VAL;
    long our_failures = 0;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        std::vector<double> times;
        for (const std::uint64_t t : records[m].ticks) {
            times.push_back(static_cast<double>(t) * tick_ns);
        }
        std::sort(times.begin(), times.end());
        BenchRow row;
        row.method = methods[m]->name();
        row.set = set.name;
        row.mode = warm ? "warm" : "cold";
        row.median_ns = quantile(times, 0.5);
        row.p99_ns = quantile(times, 0.99);
        row.p999_ns = quantile(times, 0.999);
        row.max_ns = times.back();
        row.worst_error = records[m].worst_n;
        row.failures = records[m].failures;
        if (is_daqp(row.method)) {
            daqp_ns = std::min(daqp_ns, row.median_ns);
        }
        our_failures += is_ours(row.method) ? row.failures : 0;
        rows.push_back(row);
    }
    for (std::size_t r = first_row; r < rows.size(); ++r) {
        rows[r].ratio_to_daqp = rows[r].median_ns / daqp_ns;
        print_row(rows[r]);
    }
    return our_failures;
}

} // namespace

int bench_tension(std::vector<BenchRow> &rows) {
    std::vector<std::unique_ptr<TensionMethod>> methods = tension_methods();
    if (methods.empty()) {
        return 1;
    }
    const double tick_ns = ns_per_tick();
    print_header("tension solvers; ratios to the fastest DAQP of the same set and mode");
    long failures = 0;
    for (const TensionSet &set : tension_sets()) {
        std::vector<StringArray> exact;
        for (const TensionProblem &problem : set.problems) {
            const test::Certificate truth =
                test::certify(problem, solve_tension_problem_safely(problem, nullptr).tensions_n);
            failures += truth.certified ? 0 : 1;
            exact.push_back(truth.exact_n);
        }
        if (set.smooth) {
            failures += run_set(set, exact, true, methods, tick_ns, rows);
        }
        failures += run_set(set, exact, false, methods, tick_ns, rows);
    }
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::bench
