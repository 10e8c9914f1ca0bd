#pragma once

// Array, Dictionary and Callable. Include godot_cpp/variant/array.hpp, dictionary.hpp or
// callable.hpp instead of this file.

#include <godot_cpp/internal/string_types.hpp>

namespace godot {

class Array : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_ARRAY, internal::kArraySize> {
public:
    Array() = default;

    template <typename... Args>
    static Array make(const Args &...args) {
        Array made;
        (made.push_back(Variant(args)), ...);
        return made;
    }

    // Requires an index from 0 to size() - 1; any other index crashes, as in godot-cpp.
    Variant &operator[](int64_t index);
    const Variant &operator[](int64_t index) const;
    bool operator==(const Array &other) const { return equals(other); }
    bool operator!=(const Array &other) const { return !equals(other); }

#include <godot_cpp/internal/array.methods.gen.inc>
};

// The type by which engine methods take or return an Array whose elements have one type. Only the
// engine checks the elements.
template <typename T>
class TypedArray : public Array {
public:
    TypedArray() = default;
    TypedArray(const Array &array) : Array(array) {}
};

class Dictionary
    : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_DICTIONARY, internal::kDictionarySize> {
public:
    Dictionary() = default;

    // The first operator adds a missing key; the second returns null for it.
    Variant &operator[](const Variant &key);
    const Variant &operator[](const Variant &key) const;
    bool operator==(const Dictionary &other) const { return equals(other); }
    bool operator!=(const Dictionary &other) const { return !equals(other); }

#include <godot_cpp/internal/dictionary.methods.gen.inc>
};

class Callable
    : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_CALLABLE, internal::kCallableSize> {
    friend Callable make_bound_callable(GDExtensionCallableCustomInfo2 &info);

public:
    Callable() = default;
    Callable(const Object *object, const StringName &method);

    bool operator==(const Callable &other) const { return equals(other); }
    bool operator!=(const Callable &other) const { return !equals(other); }

#include <godot_cpp/internal/callable.methods.gen.inc>
};

} // namespace godot
