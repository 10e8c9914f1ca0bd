// How validate() writes a field and a value, so that every message reads alike.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

namespace spidar {

// "0.04 m", "nan m".
[[nodiscard]] inline std::string with_unit(double value, const char *unit) {
    if (std::isnan(value)) {
        return std::string("nan ") + unit; // no sign: printf's depends on the payload
    }
    char text[64];
    std::snprintf(text, sizeof text, "%.9g %s", value, unit);
    return text;
}

// "motors_m[3] (string 4)": code counts from 0, paper and hardware from 1.
[[nodiscard]] inline std::string element_name(const char *field, std::size_t string) {
    return std::string(field) + "[" + std::to_string(string) + "] (string " +
           std::to_string(string + 1) + ")";
}

} // namespace spidar
