#pragma once

// Not part of the godot-cpp API: the functions that the error macros call.

#include <godot_cpp/variant/variant.hpp>

namespace godot::internal {

void report(const char *function, const char *file, int line, const String &condition,
            const String &message);
void warn(const char *function, const char *file, int line, const String &message);

inline bool is_outside(int64_t index, int64_t size) {
    return index < 0 || index >= size;
}

} // namespace godot::internal
