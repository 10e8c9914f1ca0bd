#pragma once

#include <godot_cpp/classes/global_constants.hpp>
#include <godot_cpp/variant/variant.hpp>

#include <vector>

namespace godot {

struct PropertyInfo {
    Variant::Type type = Variant::NIL;
    StringName name;
    StringName class_name;
    uint32_t hint = PROPERTY_HINT_NONE;
    String hint_string;
    uint32_t usage = PROPERTY_USAGE_DEFAULT;

    PropertyInfo() = default;
    // With PROPERTY_HINT_RESOURCE_TYPE, class_name becomes the hint string, as in the engine.
    PropertyInfo(Variant::Type p_type, const StringName &p_name,
                 PropertyHint p_hint = PROPERTY_HINT_NONE, const String &p_hint_string = String(),
                 uint32_t p_usage = PROPERTY_USAGE_DEFAULT,
                 const StringName &p_class_name = StringName())
        : type(p_type), name(p_name),
          class_name(p_hint == PROPERTY_HINT_RESOURCE_TYPE ? StringName(p_hint_string)
                                                           : p_class_name),
          hint(p_hint), hint_string(p_hint_string), usage(p_usage) {}
};

struct MethodInfo {
    StringName name;
    PropertyInfo return_val;
    std::vector<PropertyInfo> arguments;

    MethodInfo() = default;
    template <typename... Args>
    explicit MethodInfo(const StringName &p_name, const Args &...args)
        : name(p_name), arguments{args...} {}
};

} // namespace godot
