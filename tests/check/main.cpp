// spidar_check fk FILE.csv | spidar_check tension FILE.csv: compares the core with reference data.
#include <cstdio>
#include <cstring>

#include "check/checks.h"
#include "check/csv_reader.h"

namespace {

constexpr int kUsageError = 2;

int usage(const char *program) {
    std::fprintf(stderr, "usage: %s fk FILE.csv | %s tension FILE.csv\n", program, program);
    return kUsageError;
}

} // namespace

int main(int argc, char **argv) {
    const char *program = argc > 0 ? argv[0] : "spidar_check";
    if (argc != 3) {
        return usage(program);
    }
    try {
        if (std::strcmp(argv[1], "fk") == 0) {
            return spidar::check::check_fk(argv[2]);
        }
        if (std::strcmp(argv[1], "tension") == 0) {
            return spidar::check::check_tension(argv[2]);
        }
    } catch (const spidar::check::CsvError &error) {
        std::fprintf(stderr, "spidar_check: %s\n", error.what());
        return kUsageError;
    }
    return usage(program);
}
