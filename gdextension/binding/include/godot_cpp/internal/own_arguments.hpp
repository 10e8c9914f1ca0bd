#pragma once

// Not part of the godot-cpp API, but for the three templates below, which godot-cpp has under the same names: an add-on
// that specialises all three for a type of its own can take that type as an argument of a bound method. Here the type
// also names, as `BoundAs`, the type that it stands for. Such an argument sees every Variant and checks it itself.

#include <godot_cpp/internal/border.hpp>

namespace godot {

// What a call by Variants hands over.
template <class T>
struct VariantCaster {
    static T cast(const Variant &value) { return internal::Border<T>::from_variant(value); }
};

// What a pointer call hands over.
template <class T>
struct PtrToArg {
    static T convert(const void *address) { return internal::Border<T>::decode(address); }
};

// How the argument is shown in the class reference.
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

// The type that the binding insists on; nil: any.
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
