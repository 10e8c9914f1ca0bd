#pragma once

#include <cstddef>
#include <cstdint>

#include <gdextension_interface.h>

static_assert(sizeof(void *) == 8,
              "The in-tree binding knows the 64-bit layout of Godot's types only.");

#if defined(_WIN32)
#define GDE_EXPORT __declspec(dllexport)
#else
#define GDE_EXPORT __attribute__((visibility("default")))
#endif

namespace godot {

// The engine's real number type. generate.py refuses the API dump of a double precision engine.
using real_t = float;

// An object of the engine. The binding uses only pointers to it.
using GodotObject = void;

} // namespace godot

// godot-cpp defines real_t outside of the namespace too.
using real_t = godot::real_t;
