#pragma once

#include <godot_cpp/internal/global_enums.gen.hpp>
#include <godot_cpp/internal/own_arguments.hpp>

namespace godot::internal {

// "spidar::Probe::Mode" -> "Probe.Mode", the way class and enum are named to the engine.
StringName enum_class_name(const char *qualified_name);

} // namespace godot::internal

// At global scope, after the class, once for each enum that a bound method or constant uses.
#define VARIANT_ENUM_CAST(m_enum)                                                                  \
    template <>                                                                                    \
    struct godot::internal::EnumName<m_enum> {                                                     \
        static ::godot::StringName get() { return ::godot::internal::enum_class_name(#m_enum); }   \
    }
