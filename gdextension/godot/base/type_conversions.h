// Conversions between Godot's types and those of core/.
#pragma once

#include <cstdint>
#include <string>

#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector3.hpp>

#include "core/base/types.h"

namespace spidar {

// Converts a counter to Godot's int.
[[nodiscard]] inline std::int64_t whole(std::uint64_t count) noexcept {
    return static_cast<std::int64_t>(count);
}

// float, or double in a double-precision build of Godot.
using GodotReal = decltype(godot::Vector3::x);

[[nodiscard]] inline Vec3 to_core(const godot::Vector3 &v) noexcept {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

[[nodiscard]] inline godot::Vector3 to_godot(const Vec3 &v) noexcept {
    return {static_cast<GodotReal>(v.x), static_cast<GodotReal>(v.y), static_cast<GodotReal>(v.z)};
}

// Converts a Basis, which stores rows, to a glm matrix, which stores columns.
[[nodiscard]] inline Mat3 to_core(const godot::Basis &basis) noexcept {
    return {to_core(basis.get_column(0)), to_core(basis.get_column(1)),
            to_core(basis.get_column(2))};
}

[[nodiscard]] inline godot::Basis to_godot(const Mat3 &matrix) noexcept {
    godot::Basis basis;
    basis.set_column(0, to_godot(matrix[0]));
    basis.set_column(1, to_godot(matrix[1]));
    basis.set_column(2, to_godot(matrix[2]));
    return basis;
}

template <std::size_t kSize>
[[nodiscard]] godot::PackedFloat64Array to_godot(const std::array<double, kSize> &values) {
    godot::PackedFloat64Array packed;
    packed.resize(static_cast<std::int64_t>(kSize));
    double *out = packed.ptrw();
    for (std::size_t i = 0; i < kSize; ++i) {
        out[i] = values[i];
    }
    return packed;
}

[[nodiscard]] inline godot::PackedInt32Array to_godot(const CountArray &values) {
    godot::PackedInt32Array packed;
    packed.resize(kStringCount);
    std::int32_t *out = packed.ptrw();
    for (std::size_t i = 0; i < values.size(); ++i) {
        out[i] = values[i];
    }
    return packed;
}

// Converts UTF-8 text.
[[nodiscard]] inline godot::String to_godot(const std::string &text) {
    return godot::String::utf8(text.c_str(), static_cast<std::int64_t>(text.size()));
}

} // namespace spidar
