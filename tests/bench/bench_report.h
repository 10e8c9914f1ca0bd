// What every bench writes: rows of times against error, as a table for people and JSON for ./dev bench.
// The file has one JSON object a line, a row each, with the keys of BenchRow; a number that does not exist is null.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/sample_times.h"

namespace spidar::bench {

inline constexpr double kNoFigure = -1.0; // printed as "-", written as null

struct BenchRow {
    std::string method; // "ours avx2", "daqp 0.11.0", ...
    std::string set;    // "S2", "T1 0.1 mm", "servo step", ...
    std::string mode;   // "warm", "cold", "3 steps", ...
    double median_ns = kNoFigure;
    double p99_ns = kNoFigure;
    double p999_ns = kNoFigure;
    double max_ns = kNoFigure;
    double ratio_to_daqp = kNoFigure; // median over the median of DAQP on the same set and mode
    double worst_error = kNoFigure;   // N for tensions, m for poses
    long failures = 0;
};

[[nodiscard]] BenchRow make_row(const std::string &method, const std::string &set,
                                const std::string &mode, SampleTimes &times);

void print_header(const char *title);
void print_row(const BenchRow &row);

// --rows N: no set has more than this many problems (a quick look; 0 = all of them).
void set_row_limit(std::size_t rows);
[[nodiscard]] std::size_t limited(std::size_t rows);

// Processor, cores, load and compiler: what a committed result must say. One line.
[[nodiscard]] std::string describe_machine();

// False, with a sentence on stderr, when the file cannot be written. An empty path writes nothing.
[[nodiscard]] bool write_json(const std::string &path, const std::vector<BenchRow> &rows);

} // namespace spidar::bench
