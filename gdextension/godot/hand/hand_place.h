// Decides whether a hand acts. It acts as the first SpidarGHand under a SpidarG, in the main
// thread. Otherwise a warning says why not.
#pragma once

#include <godot_cpp/variant/packed_string_array.hpp>

class SpidarGHand;

namespace spidar {

class HandPlace {
public:
    // Returns the warnings for the editor.
    [[nodiscard]] static godot::PackedStringArray warnings(const SpidarGHand &hand);

    // Called when the hand enters the scene tree. Warns in a running scene if the parent is no
    // SpidarG.
    void entered(const SpidarGHand &hand);
    // Called in each physics tick of a hand under a SpidarG. Returns whether the hand acts. Warns
    // in the first tick in which it does not.
    [[nodiscard]] bool may_act(const SpidarGHand &hand);

private:
    bool told_ = false;
};

} // namespace spidar
