#pragma once

#include <godot_cpp/internal/global_enums.gen.hpp>
#include <godot_cpp/internal/own_arguments.hpp>

namespace godot::internal {

// Returns the engine's name of an enum: "Probe.Mode" for "spidar::Probe::Mode".
StringName enum_class_name(const char *qualified_name);

} // namespace godot::internal

// Placed at global scope after the class, once for each enum that a bound method or constant uses.
#define VARIANT_ENUM_CAST(m_enum)                                                                  \
    template <>                                                                                    \
    struct godot::internal::EnumName<m_enum> {                                                     \
        static ::godot::StringName get() { return ::godot::internal::enum_class_name(#m_enum); }   \
    }
