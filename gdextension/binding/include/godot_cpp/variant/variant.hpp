#pragma once

// Variant. This header includes all built-in types of the binding.

#include <godot_cpp/internal/packed_arrays.hpp>
#include <godot_cpp/variant/color.hpp>
#include <godot_cpp/variant/plane.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/transform3d.hpp>

namespace godot {

class Variant {
public:
    enum Type {
        NIL,
        BOOL,
        INT,
        FLOAT,
        STRING,
        VECTOR2,
        VECTOR2I,
        RECT2,
        RECT2I,
        VECTOR3,
        VECTOR3I,
        TRANSFORM2D,
        VECTOR4,
        VECTOR4I,
        PLANE,
        QUATERNION,
        AABB,
        BASIS,
        TRANSFORM3D,
        PROJECTION,
        COLOR,
        STRING_NAME,
        NODE_PATH,
        RID,
        OBJECT,
        CALLABLE,
        SIGNAL,
        DICTIONARY,
        ARRAY,
        PACKED_BYTE_ARRAY,
        PACKED_INT32_ARRAY,
        PACKED_INT64_ARRAY,
        PACKED_FLOAT32_ARRAY,
        PACKED_FLOAT64_ARRAY,
        PACKED_STRING_ARRAY,
        PACKED_VECTOR2_ARRAY,
        PACKED_VECTOR3_ARRAY,
        PACKED_COLOR_ARRAY,
        PACKED_VECTOR4_ARRAY,
        VARIANT_MAX
    };
    static_assert(static_cast<int>(VARIANT_MAX) ==
                      static_cast<int>(GDEXTENSION_VARIANT_TYPE_VARIANT_MAX),
                  "This Godot has other Variant types than the binding knows.");

    Variant() { internal::api.variant_new_nil(bytes_.data()); }
    Variant(const Variant &other) {
        internal::api.variant_new_copy(bytes_.data(), other.bytes_.data());
    }
    Variant(Variant &&other) noexcept : bytes_(other.bytes_) {
        internal::api.variant_new_nil(other.bytes_.data());
    }
    Variant(const char *text) : Variant(String(text)) {}
    Variant(const Object *object);

    template <class T>
    requires internal::Arithmetic<T> || internal::PlainEnum<T> Variant(T value) {
        if constexpr (std::is_same_v<T, bool>) {
            const GDExtensionBool wire = value ? 1 : 0;
            fill(GDEXTENSION_VARIANT_TYPE_BOOL, &wire);
        } else if constexpr (std::is_floating_point_v<T>) {
            const double wire = static_cast<double>(value);
            fill(GDEXTENSION_VARIANT_TYPE_FLOAT, &wire);
        } else {
            const int64_t wire = static_cast<int64_t>(value);
            fill(GDEXTENSION_VARIANT_TYPE_INT, &wire);
        }
    }

    template <class T>
    requires internal::Plain<T> Variant(const T &value) {
        fill(internal::PlainType<T>::value, &value);
    }

    Variant &operator=(const Variant &other) {
        if (this != &other) {
            internal::api.variant_destroy(bytes_.data());
            internal::api.variant_new_copy(bytes_.data(), other.bytes_.data());
        }
        return *this;
    }
    Variant &operator=(Variant &&other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~Variant() { internal::api.variant_destroy(bytes_.data()); }

    // Converts as the engine does: int64_t(Variant(2.5)) is 2, String(Variant(2)) is "2".
    template <class T>
    requires internal::Arithmetic<T>
    explicit operator T() const {
        if constexpr (std::is_same_v<T, bool>) {
            return booleanize();
        } else if constexpr (std::is_floating_point_v<T>) {
            double wire = 0;
            read(GDEXTENSION_VARIANT_TYPE_FLOAT, &wire);
            return static_cast<T>(wire);
        } else {
            int64_t wire = 0;
            read(GDEXTENSION_VARIANT_TYPE_INT, &wire);
            return static_cast<T>(wire);
        }
    }

    template <class T>
    requires internal::Plain<T>
    explicit operator T() const {
        // The engine constructs the value in this memory, so that none may exist there before.
        union Uninitialized {
            Uninitialized() {}
            ~Uninitialized() {}
            T value;
        } place;
        read(internal::PlainType<T>::value, &place.value);
        T result = std::move(place.value);
        place.value.~T();
        return result;
    }

    // Returns null for another type, and for an object that was freed.
    explicit operator Object *() const;

    Type get_type() const {
        return static_cast<Type>(internal::api.variant_get_type(bytes_.data()));
    }
    String stringify() const;
    bool booleanize() const { return internal::api.variant_booleanize(bytes_.data()) != 0; }
    // Values of different types are not equal, such as 1 and 1.0, or a String and a StringName.
    bool operator==(const Variant &other) const;
    bool operator!=(const Variant &other) const { return !(*this == other); }
    static String get_type_name(Type type);
    static bool can_convert_strict(Type from, Type to);

    GDExtensionVariantPtr _native_ptr() const { return const_cast<std::byte *>(bytes_.data()); }

private:
    void fill(GDExtensionVariantType type, const void *value) {
        internal::lifecycles[type].to_variant(bytes_.data(), const_cast<void *>(value));
    }
    void read(GDExtensionVariantType type, void *value) const {
        internal::lifecycles[type].from_variant(value, _native_ptr());
    }

    alignas(8) std::array<std::byte, internal::kVariantSize> bytes_;
};

static_assert(sizeof(Variant) == internal::kVariantSize);
static_assert(sizeof(Vector3) == internal::kVector3Size);
static_assert(sizeof(Quaternion) == internal::kQuaternionSize);
static_assert(sizeof(Transform3D) == internal::kTransform3DSize);
static_assert(sizeof(Color) == internal::kColorSize);
static_assert(sizeof(Plane) == internal::kPlaneSize);
static_assert(sizeof(RID) == internal::kRIDSize);
static_assert(sizeof(Dictionary) == internal::kDictionarySize);

namespace internal {
String format(const String &text, const Array &values);
} // namespace internal

// Formats as the operator % of GDScript: vformat("%d of %s", 3, name).
template <typename... Args>
String vformat(const String &text, const Args &...values) {
    return internal::format(text, Array::make(values...));
}

} // namespace godot
