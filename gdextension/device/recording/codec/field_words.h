// Converts structs to rows of named 64-bit words. A struct lists its fields once, in a function
//   for_each_field(struct, visit)   which calls   visit(name, index, field)
// for every field. Writing, reading, naming and counting use that list.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/base/types.h"

namespace spidar {

template <typename T>
[[nodiscard]] std::uint64_t to_word(T value) noexcept {
    if constexpr (std::is_same_v<T, double>) {
        return std::bit_cast<std::uint64_t>(value);
    } else {
        static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
        return static_cast<std::uint64_t>(value);
    }
}

template <typename T>
void from_word(std::uint64_t word, T &value) noexcept {
    if constexpr (std::is_same_v<T, double>) {
        value = std::bit_cast<double>(word);
    } else if constexpr (std::is_same_v<T, bool>) {
        value = word != 0;
    } else {
        value = static_cast<T>(word);
    }
}

// Counts a plain struct's members at compile time, so that a static_assert beside a list fails when
// the struct gets another member.
struct AnyMember {
    template <typename T>
    operator T() const noexcept; // never defined: only its type is used
};
template <typename Struct, typename... Members>
[[nodiscard]] constexpr std::size_t count_members() noexcept {
    if constexpr (requires { Struct{Members{}..., AnyMember{}}; }) {
        return count_members<Struct, Members..., AnyMember>();
    } else {
        return sizeof...(Members);
    }
}

// Helpers for field lists: a vector has three fields, an array one per element (`index`).
template <typename Vector, typename Visit>
void visit_vector(std::string_view name, int index, Vector &vector, Visit &&visit) {
    for (int axis = 0; axis < 3; ++axis) {
        visit(name, 3 * index + axis, vector[axis]);
    }
}

template <typename Matrix, typename Visit>
void visit_matrix(std::string_view name, int index, Matrix &matrix, Visit &&visit) {
    for (int column = 0; column < 3; ++column) {
        visit_vector(name, 3 * index + column, matrix[column], visit);
    }
}

template <typename Array, typename Visit>
void visit_array(std::string_view name, Array &values, Visit &&visit) {
    int index = 0;
    for (auto &value : values) {
        visit(name, index, value);
        ++index;
    }
}

template <typename Vectors, typename Visit>
void visit_vectors(std::string_view name, Vectors &vectors, Visit &&visit) {
    int index = 0;
    for (auto &vector : vectors) {
        visit_vector(name, index, vector, visit);
        ++index;
    }
}

// Returns the number of fields in a struct's list.
template <typename Struct>
[[nodiscard]] std::size_t count_fields(const Struct &value) noexcept {
    std::size_t count = 0;
    for_each_field(value, [&count](std::string_view, int, const auto &) { ++count; });
    return count;
}

// Returns a hash of names, order and kinds (floating-point or integer) of a list. If two hashes are
// equal, the words have the same meaning.
template <typename Struct>
[[nodiscard]] std::uint64_t schema_of(const Struct &value) noexcept {
    std::uint64_t hash = 0xCBF29CE484222325U; // FNV-1a
    const auto mix = [&hash](std::uint64_t part) {
        constexpr std::uint64_t kPrime = 0x100000001B3U;
        hash = (hash ^ part) * kPrime;
    };
    for_each_field(value, [&mix](std::string_view name, int index, const auto &field) {
        for (const char letter : name) {
            mix(static_cast<std::uint8_t>(letter));
        }
        mix(static_cast<std::uint64_t>(index));
        mix(std::is_same_v<std::remove_cvref_t<decltype(field)>, double> ? 1U : 2U);
    });
    return hash;
}

// Stores all fields; `words` must have count_fields() elements.
template <typename Struct>
void store_words(const Struct &value, std::span<std::uint64_t> words) noexcept {
    std::size_t next = 0;
    for_each_field(value, [&](std::string_view, int, const auto &field) {
        words[next] = to_word(field);
        ++next;
    });
}

// Loads all fields from words of store_words().
template <typename Struct>
void load_words(std::span<const std::uint64_t> words, Struct &value) noexcept {
    std::size_t next = 0;
    for_each_field(value, [&](std::string_view, int, auto &field) {
        from_word(words[next], field);
        ++next;
    });
}

} // namespace spidar
