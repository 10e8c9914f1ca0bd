// Options of the stress programs: --name NUMBER.
#pragma once

#include <cstdlib>
#include <cstring>

namespace spidar::test {

// The text after `name` on the command line; null when it is not there.
inline const char *option_text(int argc, char **argv, const char *name) {
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], name) == 0) {
            return argv[i + 1];
        }
    }
    return nullptr;
}

inline long whole_option(int argc, char **argv, const char *name, long otherwise) {
    const char *const text = option_text(argc, argv, name);
    return text != nullptr ? std::strtol(text, nullptr, 10) : otherwise;
}

inline double number_option(int argc, char **argv, const char *name, double otherwise) {
    const char *const text = option_text(argc, argv, name);
    return text != nullptr ? std::strtod(text, nullptr) : otherwise;
}

} // namespace spidar::test
