// Where the physics engines of Godot differ in what they make of the same shape.
#pragma once

namespace spidar {

struct EngineHabits {
    // Spheres, capsules and cylinders of uneven scale get the mean of their scales, as in Jolt. Otherwise they are stretched.
    bool evens_round_shapes = true;
    // The engine has a world boundary's plane on the other side of the origin: Jolt in Godot 4.4 to 4.6.
    bool turns_boundaries = false;
};

// Of the engine in use, found out at the first call. Main thread, not while physics steps.
[[nodiscard]] const EngineHabits &engine_habits();

} // namespace spidar
