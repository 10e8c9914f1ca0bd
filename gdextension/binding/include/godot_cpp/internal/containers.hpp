#pragma once

// Array, Dictionary and Callable. Include <godot_cpp/variant/array.hpp> and its like instead.

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

    // An index outside 0..size()-1 is the caller's error and a crash, as in godot-cpp: check size() first.
    Variant &operator[](int64_t index);
    const Variant &operator[](int64_t index) const;
    bool operator==(const Array &other) const { return equals(other); }
    bool operator!=(const Array &other) const { return !equals(other); }

#include <godot_cpp/internal/array.methods.gen.inc>
};

// What the engine takes and gives for arrays of one type: an Array whose elements the engine checks.
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

    // The first form makes a missing key, the second reads it as null.
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
