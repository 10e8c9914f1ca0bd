#pragma once

// String, StringName and NodePath. Include a header such as godot_cpp/variant/string.hpp instead.

#include <godot_cpp/internal/opaque.hpp>

#include <string>

namespace godot {

// The UTF-8 text that String::utf8() returns.
class CharString {
    friend class String;

public:
    const char *get_data() const { return text_.c_str(); }
    int64_t length() const { return static_cast<int64_t>(text_.size()); }

private:
    std::string text_;
};

class String : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_STRING, internal::kStringSize> {
public:
    String() = default;
    // Reads `text` as Latin-1, as godot-cpp does. For UTF-8 text use String::utf8().
    String(const char *text);
    explicit String(const StringName &name);
    explicit String(const NodePath &path);

    // length: number of bytes; -1: up to the terminating zero.
    static String utf8(const char *text, int64_t length = -1);
    CharString utf8() const;

    String operator+(const String &other) const;
    String operator+(const char *other) const = delete; // ambiguous in godot-cpp: String("...")
    String &operator+=(const String &other);
    bool operator==(const String &other) const { return equals(other); }
    bool operator!=(const String &other) const { return !equals(other); }
    bool operator==(const char *other) const { return equals(String(other)); }
    bool operator!=(const char *other) const { return !equals(String(other)); }
    bool operator<(const String &other) const;

#include <godot_cpp/internal/string.methods.gen.inc>
};

class StringName
    : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_STRING_NAME, internal::kStringNameSize> {
public:
    StringName() = default;
    StringName(const char *text);
    StringName(const String &text);

    // The engine stores each name once, so that equal names have equal bytes.
    bool operator==(const StringName &other) const { return same_bytes(other); }
    bool operator!=(const StringName &other) const { return !same_bytes(other); }
    bool operator==(const char *other) const = delete; // ambiguous in godot-cpp: StringName("...")
    bool operator!=(const char *other) const = delete;

#include <godot_cpp/internal/string_name.methods.gen.inc>
};

class NodePath
    : public internal::Opaque<GDEXTENSION_VARIANT_TYPE_NODE_PATH, internal::kNodePathSize> {
public:
    NodePath() = default;
    NodePath(const String &path);
    NodePath(const char *path) : NodePath(String(path)) {}

    bool operator==(const NodePath &other) const { return equals(other); }
    bool operator!=(const NodePath &other) const { return !equals(other); }

#include <godot_cpp/internal/node_path.methods.gen.inc>
};

} // namespace godot
