#include "bench/bench_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <thread>

namespace spidar::bench {

namespace {

std::size_t row_limit = 0;

bool exists(double figure) {
    return figure >= 0.0 && std::isfinite(figure); // false for NaN too
}

std::string text_of(const char *format, double figure) {
    if (!exists(figure)) {
        return "-";
    }
    char text[32];
    std::snprintf(text, sizeof text, format, figure);
    return text;
}

std::string quoted(const std::string &text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            result += '\\';
        }
        result += c;
    }
    return result + '"';
}

void write_number(std::ostream &out, const char *key, double figure) {
    out << ", \"" << key << "\": ";
    if (exists(figure)) {
        out << figure;
    } else {
        out << "null";
    }
}

// "model name : X" of the first processor; empty where there is no such file.
std::string processor_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.rfind("model name", 0) == 0) {
            const std::size_t colon = line.find(": ");
            return colon == std::string::npos ? line : line.substr(colon + 2);
        }
    }
    return {};
}

} // namespace

BenchRow make_row(const std::string &method, const std::string &set, const std::string &mode,
                  SampleTimes &times) {
    BenchRow row;
    row.method = method;
    row.set = set;
    row.mode = mode;
    row.median_ns = times.quantile_ns(0.5);
    row.p99_ns = times.quantile_ns(0.99);
    row.p999_ns = times.quantile_ns(0.999);
    row.max_ns = times.quantile_ns(1.0);
    return row;
}

void print_header(const char *title) {
    std::printf("\n%s\n%-38s %-12s %-8s %8s %8s %8s %8s %7s %10s %9s\n", title, "method", "set",
                "mode", "median", "p99", "p99.9", "max ns", "x daqp", "worst err", "failures");
}

void print_row(const BenchRow &row) {
    std::printf("%-38s %-12s %-8s %8s %8s %8s %8s %7s %10s %9ld\n", row.method.c_str(),
                row.set.c_str(), row.mode.c_str(), text_of("%.0f", row.median_ns).c_str(),
                text_of("%.0f", row.p99_ns).c_str(), text_of("%.0f", row.p999_ns).c_str(),
                text_of("%.0f", row.max_ns).c_str(), text_of("%.3f", row.ratio_to_daqp).c_str(),
                text_of("%.2e", row.worst_error).c_str(), row.failures);
    std::fflush(stdout);
}

void set_row_limit(std::size_t rows) {
    row_limit = rows;
}

std::size_t limited(std::size_t rows) {
    return row_limit == 0 ? rows : std::min(rows, row_limit);
}

std::string describe_machine() {
    std::string name = processor_name();
    std::string load;
    std::ifstream average("/proc/loadavg");
    std::getline(average, load);
    std::ostringstream text;
    text << (name.empty() ? "unknown processor" : name) << ", "
         << std::thread::hardware_concurrency() << " cores, load "
         << (load.empty() ? "unknown" : load.substr(0, load.find(' '))) << ", compiler "
#if defined(__clang__)
         << "clang " << __clang_version__;
#elif defined(__GNUC__)
         << "gcc " << __VERSION__;
#else
         << "unknown";
#endif
    return text.str();
}

bool write_json(const std::string &path, const std::vector<BenchRow> &rows) {
    if (path.empty()) {
        return true;
    }
    std::ofstream out(path);
    out << std::setprecision(6);
    for (const BenchRow &row : rows) {
        out << "{\"method\": " << quoted(row.method) << ", \"set\": " << quoted(row.set)
            << ", \"mode\": " << quoted(row.mode);
        write_number(out, "median_ns", row.median_ns);
        write_number(out, "p99_ns", row.p99_ns);
        write_number(out, "p999_ns", row.p999_ns);
        write_number(out, "max_ns", row.max_ns);
        write_number(out, "ratio_to_daqp", row.ratio_to_daqp);
        write_number(out, "worst_error", row.worst_error);
        out << ", \"failures\": " << row.failures << "}\n";
    }
    out.close();
    if (!out) {
        std::fprintf(stderr,
                     "spidar_bench: cannot write %s: give a file in a folder that exists.\n",
                     path.c_str());
        return false;
    }
    return true;
}

} // namespace spidar::bench
