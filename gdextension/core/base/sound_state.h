// A recording holds the memory of a servo step as it was. Before such a memory is used, each part says by is_sound()
// whether everything in it that is no plain number may be used: a flag is true or false, an enumeration one of its values,
// a count or an index in its range. Numbers may be any: a step takes whatever comes.
#pragma once

#include <cstring>

#include "core/base/types.h"

namespace spidar {

// A bool that was copied from a file may hold any byte, and then must not even be read as one.
template <typename... Flags>
[[nodiscard]] bool are_flags(const Flags &...flags) noexcept {
    const auto is_flag = [](const bool &flag) {
        unsigned char byte = 0;
        std::memcpy(&byte, &flag, sizeof byte);
        return byte <= 1;
    };
    return (is_flag(flags) && ...);
}

template <typename Enum>
[[nodiscard]] constexpr bool is_one_of(Enum value, Enum last) noexcept {
    return value <= last;
}

// Counts ticks, and has room to go on doing so.
[[nodiscard]] constexpr bool is_tally(int value) noexcept {
    constexpr int kMost = 1'000'000'000;
    return value >= 0 && value <= kMost;
}

// 0 to 7, or -1 for none.
[[nodiscard]] constexpr bool is_string_or_none(int string) noexcept {
    return string >= -1 && string < kStringCount;
}

} // namespace spidar
