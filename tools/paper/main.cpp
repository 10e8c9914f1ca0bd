// spidar_paper --data DIR --out DIR: recomputes the paper's tables and figures with the core, as CSV.
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "paper/sections.h"

int main(int argc, char **argv) {
    std::string data;
    std::string out;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (std::strcmp(argv[i], "--data") == 0) {
            data = argv[i + 1];
        } else if (std::strcmp(argv[i], "--out") == 0) {
            out = argv[i + 1];
        }
    }
    if (argc != 5 || data.empty() || out.empty()) {
        std::fprintf(stderr, "usage: %s --data DIR --out DIR (DIR must exist)\n",
                     argc > 0 ? argv[0] : "spidar_paper");
        return 2;
    }
    try {
        using namespace spidar::paper;
        Outputs outputs(out);
        closure_map(outputs);
        string_connections(outputs);
        string_errors(outputs, data);
        capacity(outputs);
        position_errors(outputs, data);
        grasp_and_release(outputs, data);
        scaling(outputs);
        centre(outputs);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "spidar_paper: %s\n", error.what());
        return 1;
    }
    return 0;
}
