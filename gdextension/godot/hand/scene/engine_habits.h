// Differences between Godot's physics engines in how they treat a shape.
#pragma once

namespace spidar {

struct EngineHabits {
    // True: spheres, capsules and cylinders of uneven scale get the mean of their scales, as in
    // Jolt. False: they are stretched.
    bool evens_round_shapes = true;
    // True: a world boundary's plane is mirrored at the origin (Jolt in Godot 4.4 to 4.6).
    bool turns_boundaries = false;
};

// Returns the engine's habits, tested at the first call. Main thread, not while physics steps.
[[nodiscard]] const EngineHabits &engine_habits();

} // namespace spidar
