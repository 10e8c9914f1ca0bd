#pragma once

// The packed arrays. Include a header such as godot_cpp/variant/packed_float64_array.hpp instead.

#include <godot_cpp/internal/containers.hpp>
#include <godot_cpp/variant/vector2.hpp>
#include <godot_cpp/variant/vector3.hpp>

// ptr() and ptrw() return null for an empty array. operator[] requires an index from 0 to size() -
// 1, as in godot-cpp. In a loop, check size() once and use ptr().
#define GODOT_BINDING_PACKED_ARRAY(m_class, m_type, m_function, m_element)                         \
    class m_class                                                                                  \
        : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_##m_type, internal::k##m_class##Size> { \
    public:                                                                                        \
        m_class() = default;                                                                       \
        const m_element *ptr() const { return address(0); }                                        \
        m_element *ptrw() { return address_to_write(0); }                                          \
        const m_element &operator[](int64_t index) const { return *address(index); }               \
        m_element &operator[](int64_t index) { return *address_to_write(index); }                  \
        bool operator==(const m_class &other) const { return equals(other); }                      \
        bool operator!=(const m_class &other) const { return !equals(other); }                     \
                                                                                                   \
    private:                                                                                       \
        const m_element *address(int64_t index) const {                                            \
            return static_cast<const m_element *>(                                                 \
                internal::api.m_function##_operator_index_const(_native_ptr(), index));            \
        }                                                                                          \
        m_element *address_to_write(int64_t index) {                                               \
            return static_cast<m_element *>(                                                       \
                internal::api.m_function##_operator_index(_native_ptr(), index));                  \
        }                                                                                          \
                                                                                                   \
    public:

namespace godot {

// clang-format off: each of these opens a class, which the line after its methods closes.
GODOT_BINDING_PACKED_ARRAY(PackedByteArray, PACKED_BYTE_ARRAY, packed_byte_array, uint8_t)
#include <godot_cpp/internal/packed_byte_array.methods.gen.inc>
};
GODOT_BINDING_PACKED_ARRAY(PackedInt32Array, PACKED_INT32_ARRAY, packed_int32_array, int32_t)
#include <godot_cpp/internal/packed_int32_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedInt64Array, PACKED_INT64_ARRAY, packed_int64_array, int64_t)
#include <godot_cpp/internal/packed_int64_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedFloat32Array, PACKED_FLOAT32_ARRAY, packed_float32_array, float)
#include <godot_cpp/internal/packed_float32_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedFloat64Array, PACKED_FLOAT64_ARRAY, packed_float64_array, double)
#include <godot_cpp/internal/packed_float64_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedStringArray, PACKED_STRING_ARRAY, packed_string_array, String)
#include <godot_cpp/internal/packed_string_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedVector2Array, PACKED_VECTOR2_ARRAY, packed_vector2_array, Vector2)
#include <godot_cpp/internal/packed_vector2_array.methods.gen.inc>
}
;
GODOT_BINDING_PACKED_ARRAY(PackedVector3Array, PACKED_VECTOR3_ARRAY, packed_vector3_array, Vector3)
#include <godot_cpp/internal/packed_vector3_array.methods.gen.inc>
}
;
// clang-format on

} // namespace godot

#undef GODOT_BINDING_PACKED_ARRAY
