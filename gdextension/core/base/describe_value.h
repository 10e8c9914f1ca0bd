// How validate() writes a field and a value, so that all messages have one form.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace spidar {

// Returns "0.04 m" or "nan m"; the number alone when the unit is empty.
[[nodiscard]] inline std::string with_unit(double value, std::string_view unit) {
    char digits[32] = "nan"; // without a sign, which printf would take from the NaN's payload
    if (!std::isnan(value)) {
        std::snprintf(digits, sizeof digits, "%.9g", value);
    }
    std::string text = digits;
    if (!unit.empty()) {
        text.append(" ").append(unit);
    }
    return text;
}

// Returns "motors_m[3] (string 4)": code counts strings from 0, paper and hardware from 1.
[[nodiscard]] inline std::string element_name(const char *field, std::size_t string) {
    return std::string(field) + "[" + std::to_string(string) + "] (string " +
           std::to_string(string + 1) + ")";
}

// Returns "rate_hz is 5 Hz; give 100 or more." `remedy`: the rest of the sentence, with its full
// stop.
[[nodiscard]] inline std::string range_sentence(std::string_view field, double value,
                                                std::string_view unit, std::string_view remedy) {
    return std::string(field)
        .append(" is ")
        .append(with_unit(value, unit))
        .append("; ")
        .append(remedy);
}

// A field, its value and the range least..most (both included) that validate() accepts.
struct ValueRange {
    const char *field;
    double value;
    const char *unit;
    double least;
    double most;
};

// Returns "rate_hz is 5 Hz; set it between 100 and 4000 Hz.", or an empty string when the value
// lies within the range. NaN lies in no range.
[[nodiscard]] inline std::string range_sentence(const ValueRange &range) {
    if (range.value >= range.least && range.value <= range.most) {
        return {};
    }
    return range_sentence(range.field, range.value, range.unit,
                          "set it between " + with_unit(range.least, "") + " and " +
                              with_unit(range.most, range.unit) + ".");
}

// Returns the sentence of the first field that is out of its range, or an empty string.
[[nodiscard]] inline std::string first_out_of_range(std::span<const ValueRange> ranges) {
    for (const ValueRange &range : ranges) {
        std::string sentence = range_sentence(range);
        if (!sentence.empty()) {
            return sentence;
        }
    }
    return {};
}

} // namespace spidar
