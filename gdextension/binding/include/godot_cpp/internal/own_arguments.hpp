#pragma once

// Bound methods whose arguments have a type of the add-on. The add-on specializes the first three
// templates, which godot-cpp has under the same names. In this binding, the type must also name, as
// BoundAs, the type that scripts pass. The binding does not check such an argument: its conversion
// sees every Variant. The rest of the file is not part of the godot-cpp API.

#include <godot_cpp/internal/border.hpp>

namespace godot {

// Converts an argument of a call by Variants.
template <class T>
struct VariantCaster {
    static T cast(const Variant &value) { return internal::Border<T>::from_variant(value); }
};

// Converts an argument of a call by pointers.
template <class T>
struct PtrToArg {
    static T convert(const void *address) { return internal::Border<T>::decode(address); }
};

// Describes the argument's type to the engine.
template <class T, typename = void>
struct GetTypeInfo {
    static constexpr Variant::Type VARIANT_TYPE = internal::Border<T>::type;
    static PropertyInfo get_class_info() { return internal::Border<T>::info(); }
};

namespace internal {

template <class T>
concept OwnArgument = requires {
    typename T::BoundAs;
};

template <OwnArgument T>
struct Border<T> {
    using As = Border<Decayed<typename T::BoundAs>>;
    static constexpr Variant::Type type = As::type;
    static constexpr auto metadata = As::metadata;
    static T decode(const void *address) { return PtrToArg<T>::convert(address); }
    static T from_variant(const Variant &value) { return VariantCaster<T>::cast(value); }
    static PropertyInfo info() { return GetTypeInfo<T>::get_class_info(); }
};

// Returns the type that the binding requires of an argument; NIL: any.
template <class T>
constexpr Variant::Type insisted_type() {
    if constexpr (OwnArgument<T>) {
        return Variant::NIL;
    } else {
        return Border<T>::type;
    }
}

} // namespace internal
} // namespace godot
