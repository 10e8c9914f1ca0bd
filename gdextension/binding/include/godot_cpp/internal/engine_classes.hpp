#pragma once

// Not part of the godot-cpp API: the engine classes that generate.py made, derived classes first.

#include <godot_cpp/classes/wrapped.hpp>

#include <atomic>

namespace godot::internal {

struct EngineClass {
    const char *name;
    Wrapped *(*wrap)(GodotObject *);
    std::atomic<void *> tag; // the engine's mark of the class, looked up when first needed
};

extern EngineClass engine_classes[];
extern const std::size_t engine_class_count;

} // namespace godot::internal
