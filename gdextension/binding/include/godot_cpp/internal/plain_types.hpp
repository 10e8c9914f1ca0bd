#pragma once

// Not part of the godot-cpp API: the C++ types whose bytes are the same here and in the engine.

#include <godot_cpp/core/defs.hpp>

#include <type_traits>

namespace godot {

class Variant;
struct Vector2;
struct Vector3;
struct Quaternion;
struct Basis;
struct Transform3D;
struct Color;
struct Plane;
class RID;
class String;
class StringName;
class NodePath;
class Callable;
class Dictionary;
class Array;
template <typename T>
class TypedArray;
class PackedByteArray;
class PackedInt32Array;
class PackedInt64Array;
class PackedFloat32Array;
class PackedFloat64Array;
class PackedStringArray;
class PackedVector2Array;
class PackedVector3Array;
class Object;
class Wrapped;
template <typename T>
class Ref;

namespace internal {

template <class T>
struct PlainType;

#define GODOT_BINDING_PLAIN(m_class, m_type)                                                       \
    template <>                                                                                    \
    struct PlainType<m_class> {                                                                    \
        static constexpr GDExtensionVariantType value = GDEXTENSION_VARIANT_TYPE_##m_type;         \
    }
GODOT_BINDING_PLAIN(Vector2, VECTOR2);
GODOT_BINDING_PLAIN(Vector3, VECTOR3);
GODOT_BINDING_PLAIN(Quaternion, QUATERNION);
GODOT_BINDING_PLAIN(Basis, BASIS);
GODOT_BINDING_PLAIN(Transform3D, TRANSFORM3D);
GODOT_BINDING_PLAIN(Color, COLOR);
GODOT_BINDING_PLAIN(Plane, PLANE);
GODOT_BINDING_PLAIN(RID, RID);
GODOT_BINDING_PLAIN(String, STRING);
GODOT_BINDING_PLAIN(StringName, STRING_NAME);
GODOT_BINDING_PLAIN(NodePath, NODE_PATH);
GODOT_BINDING_PLAIN(Callable, CALLABLE);
GODOT_BINDING_PLAIN(Dictionary, DICTIONARY);
GODOT_BINDING_PLAIN(Array, ARRAY);
GODOT_BINDING_PLAIN(PackedByteArray, PACKED_BYTE_ARRAY);
GODOT_BINDING_PLAIN(PackedInt32Array, PACKED_INT32_ARRAY);
GODOT_BINDING_PLAIN(PackedInt64Array, PACKED_INT64_ARRAY);
GODOT_BINDING_PLAIN(PackedFloat32Array, PACKED_FLOAT32_ARRAY);
GODOT_BINDING_PLAIN(PackedFloat64Array, PACKED_FLOAT64_ARRAY);
GODOT_BINDING_PLAIN(PackedStringArray, PACKED_STRING_ARRAY);
GODOT_BINDING_PLAIN(PackedVector2Array, PACKED_VECTOR2_ARRAY);
GODOT_BINDING_PLAIN(PackedVector3Array, PACKED_VECTOR3_ARRAY);
#undef GODOT_BINDING_PLAIN

template <typename T>
struct PlainType<TypedArray<T>> : PlainType<Array> {};

template <class T>
concept Plain = requires {
    PlainType<T>::value;
};

template <class T, class... Others>
concept OneOf = (std::is_same_v<T, Others> || ...);

// The arithmetic types that godot-cpp passes to the engine. char and long double are not among
// them, and of long and long long only the one that int64_t is.
template <class T>
concept Arithmetic = OneOf<T, bool, int8_t, int16_t, int32_t, int64_t, uint8_t, uint16_t, uint32_t,
                           uint64_t, float, double>;

template <class T>
concept Number = Arithmetic<T> || std::is_enum_v<T>;

// Enums that convert to integers implicitly, as the constructor of Variant requires.
template <class T>
concept PlainEnum = std::is_enum_v<T> && std::is_convertible_v<T, int64_t>;

} // namespace internal
} // namespace godot
