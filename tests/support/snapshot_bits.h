// All bits of a snapshot as one number: two runs of equal numbers told the game exactly the same.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "device/contract/servo_snapshot.h"

namespace spidar::test {

inline std::uint64_t bits_of(const ServoSnapshot &snapshot) {
    static_assert(std::is_trivially_copyable_v<ServoSnapshot>);
    static_assert(sizeof(ServoSnapshot) % sizeof(std::uint64_t) == 0);
    ServoSnapshot copy = snapshot;
    // What lies between members says nothing. GCC 12 forgets that of structs in arrays, and what comes after: those one
    // by one.
    __builtin_clear_padding(&copy);
    __builtin_clear_padding(&copy.clamp);
    for (ContactReport &contact : copy.contacts) {
        __builtin_clear_padding(&contact);
    }
    for (TouchPartReport &part : copy.touch.parts) {
        __builtin_clear_padding(&part);
    }
    std::array<std::uint64_t, sizeof(ServoSnapshot) / sizeof(std::uint64_t)> words{};
    std::memcpy(words.data(), &copy, sizeof copy);
    std::uint64_t hash = 1;
    for (const std::uint64_t word : words) {
        constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;
        constexpr unsigned kShift = 29;
        hash = (hash ^ word) * kOdd;
        hash ^= hash >> kShift;
    }
    return hash;
}

} // namespace spidar::test
