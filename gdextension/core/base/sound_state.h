// Checks for memory that was restored from a recording. A part's is_sound() returns true when its
// flags are 0 or 1, its enumerations hold a defined value, and its counts and indices are in range.
// Floating-point values are not checked: a servo step accepts any.
#pragma once

#include <cstring>

#include "core/base/types.h"

namespace spidar {

// True when every flag holds 0 or 1. The bytes are read, since reading a bool with another value is
// undefined behavior.
template <typename... Flags>
[[nodiscard]] bool are_flags(const Flags &...flags) noexcept {
    const auto is_flag = [](const bool &flag) {
        unsigned char byte = 0;
        std::memcpy(&byte, &flag, sizeof byte);
        return byte <= 1;
    };
    return (is_flag(flags) && ...);
}

// Requires an enumeration of unsigned type with values from 0 to `last` without gaps.
template <typename Enum>
[[nodiscard]] constexpr bool is_one_of(Enum value, Enum last) noexcept {
    return value <= last;
}

// True for a tick counter within 0..1e9, which leaves room to count on.
[[nodiscard]] constexpr bool is_tally(int value) noexcept {
    constexpr int kMost = 1'000'000'000;
    return value >= 0 && value <= kMost;
}

// True for a string index 0..7, or -1 for none.
[[nodiscard]] constexpr bool is_string_or_none(int string) noexcept {
    return string >= -1 && string < kStringCount;
}

} // namespace spidar
