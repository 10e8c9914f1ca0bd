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

// Godot's own real number. generate.py refuses the dump of a double precision engine.
using real_t = float;

// An object on the engine's side of the border: only ever a handle here.
using GodotObject = void;

} // namespace godot

// godot-cpp has it outside of the namespace too.
using real_t = godot::real_t;
