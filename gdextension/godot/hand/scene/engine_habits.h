// How the physics engine in use treats shapes, where Godot's engines differ.
#pragma once

namespace spidar {

struct EngineHabits {
    // True, as in Jolt: a sphere, capsule or cylinder with different scales along its axes gets
    // their mean. False: it is stretched.
    bool evens_round_shapes = true;
    // True: a world boundary's plane is mirrored at the origin (Jolt in Godot 4.4 to 4.6).
    bool turns_boundaries = false;
};

// Returns the habits, which the first call finds out by the project setting and a test. Call it
// from the main thread, not during a physics step.
[[nodiscard]] const EngineHabits &engine_habits();

} // namespace spidar
