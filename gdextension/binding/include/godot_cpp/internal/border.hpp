#pragma once

// Not part of the godot-cpp API: converts C++ values to the engine's form and back.
//
// Border<T> holds the conversions of type T for calls by pointers, for Variants and for type
// descriptions:
//   lend(value, slot)    address of an argument for the engine; valid while value and slot live
//   decode(address)      an argument that the engine passes to a method of this library
//   take(result)         a return value that the engine wrote, and that this library then owns
//   give(address, value) writes a return value of this library to the engine's address
//   from_variant, to_variant, type, metadata, info
// The Border of object pointers is in core/object.hpp, that of Ref in classes/ref.hpp.

#include <godot_cpp/core/property_info.hpp>

namespace godot::internal {

template <class T>
struct Border;

template <class T>
using Decayed = std::remove_cv_t<std::remove_reference_t<T>>;

// Holds "Class.Enum" for an enum; VARIANT_ENUM_CAST specializes it.
template <class T>
struct EnumName;

// The type in which a call by pointers passes T: a byte for bool, int64_t for integers and enums,
// double for float and double.
template <class T>
using Wire = std::conditional_t<std::is_same_v<T, bool>, GDExtensionBool,
                                std::conditional_t<std::is_floating_point_v<T>, double, int64_t>>;

template <class T>
constexpr GDExtensionClassMethodArgumentMetadata metadata_of() {
    if constexpr (std::is_same_v<T, float>) {
        return GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_FLOAT;
    } else if constexpr (std::is_same_v<T, double>) {
        return GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_DOUBLE;
    } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
        // The enumerators are INT8, INT16, INT32 and INT64 (1 to 4), then the unsigned ones.
        constexpr int kLog2 = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
        return static_cast<GDExtensionClassMethodArgumentMetadata>((std::is_signed_v<T> ? 1 : 5) +
                                                                   kLog2);
    } else {
        return GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    }
}

template <Number T>
struct Border<T> {
    static constexpr Variant::Type type = std::is_same_v<T, bool>       ? Variant::BOOL
                                          : std::is_floating_point_v<T> ? Variant::FLOAT
                                                                        : Variant::INT;
    static constexpr auto metadata = metadata_of<T>();

    using Slot = Wire<T>;
    using Result = Wire<T>;
    static const void *lend(T value, Slot &slot) {
        slot = static_cast<Slot>(value);
        return &slot;
    }
    static T decode(const void *address) {
        return static_cast<T>(*static_cast<const Wire<T> *>(address));
    }
    static T take(Result &result) { return static_cast<T>(result); }
    static void give(void *address, T value) {
        *static_cast<Wire<T> *>(address) = static_cast<Wire<T>>(value);
    }
    static T from_variant(const Variant &value) {
        if constexpr (std::is_enum_v<T>) {
            return static_cast<T>(static_cast<int64_t>(value));
        } else {
            return static_cast<T>(value);
        }
    }
    static Variant to_variant(T value) {
        if constexpr (std::is_enum_v<T>) {
            return Variant(static_cast<int64_t>(value));
        } else {
            return Variant(value);
        }
    }
    static PropertyInfo info() {
        if constexpr (std::is_enum_v<T>) {
            return {type,
                    StringName(),
                    PROPERTY_HINT_NONE,
                    String(),
                    PROPERTY_USAGE_DEFAULT | PROPERTY_USAGE_CLASS_IS_ENUM,
                    EnumName<T>::get()};
        } else {
            return {type, StringName()};
        }
    }
};

template <class T>
requires Plain<T> || std::is_same_v<T, Variant>
struct Border<T> {
    static constexpr bool kIsVariant = std::is_same_v<T, Variant>;
    static constexpr Variant::Type type = [] {
        if constexpr (kIsVariant) {
            return Variant::NIL;
        } else {
            return static_cast<Variant::Type>(PlainType<T>::value);
        }
    }();
    static constexpr auto metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    struct Slot {};
    using Result = T;
    static const void *lend(const T &value, Slot &) { return &value; }
    static const T &decode(const void *address) { return *static_cast<const T *>(address); }
    static T take(Result &result) { return std::move(result); }
    static void give(void *address, const T &value) { *static_cast<T *>(address) = value; }
    static T from_variant(const Variant &value) {
        if constexpr (kIsVariant) {
            return value;
        } else {
            return static_cast<T>(value);
        }
    }
    static Variant to_variant(const T &value) { return Variant(value); }
    static PropertyInfo info() {
        constexpr uint32_t kUsage =
            PROPERTY_USAGE_DEFAULT | (kIsVariant ? uint32_t{PROPERTY_USAGE_NIL_IS_VARIANT} : 0U);
        return {type, StringName(), PROPERTY_HINT_NONE, String(), kUsage};
    }
};

} // namespace godot::internal
