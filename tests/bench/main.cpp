// spidar_bench contacts|fk|motions|recording|tension|step|touch [--json FILE] [--rows N]: times against error, peers in the same process.
// Times come from a shared machine: read the ratios between rows of one run.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bench/bench_contacts.h"
#include "bench/bench_fk.h"
#include "bench/bench_motions.h"
#include "bench/bench_recording.h"
#include "bench/bench_report.h"
#include "bench/bench_step.h"
#include "bench/bench_tension.h"
#include "bench/bench_touch.h"

namespace {

using spidar::bench::BenchRow;

struct Problem {
    const char *name;
    int (*run)(std::vector<BenchRow> &rows); // 0 when every row ran as it says
};

constexpr Problem kProblems[] = {
    {"contacts", spidar::bench::bench_contacts},   {"fk", spidar::bench::bench_fk},
    {"recording", spidar::bench::bench_recording}, {"step", spidar::bench::bench_step},
    {"motions", spidar::bench::bench_motions},     {"tension", spidar::bench::bench_tension},
    {"touch", spidar::bench::bench_touch},
};

int usage() {
    std::fprintf(stderr, "usage: spidar_bench [PROBLEM] [--json FILE] [--rows N], PROBLEM one of:");
    for (const Problem &problem : kProblems) {
        std::fprintf(stderr, " %s", problem.name);
    }
    std::fprintf(stderr, "\n");
    return 2;
}

} // namespace

int main(int argc, char **argv) {
    const char *name = "step";
    std::string json;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--json") == 0 && i + 1 < argc) {
            json = argv[++i];
        } else if (std::strcmp(argv[i], "--rows") == 0 && i + 1 < argc) {
            spidar::bench::set_row_limit(std::strtoull(argv[++i], nullptr, 10));
        } else if (i == 1 && argv[i][0] != '-') {
            name = argv[i];
        } else {
            return usage();
        }
    }
    for (const Problem &problem : kProblems) {
        if (std::strcmp(problem.name, name) == 0) {
            std::printf("%s\n", spidar::bench::describe_machine().c_str());
            std::vector<BenchRow> rows;
            const int code = problem.run(rows);
            return spidar::bench::write_json(json, rows) ? code : 1;
        }
    }
    return usage();
}
