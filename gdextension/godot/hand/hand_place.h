// Decides where in the scene a hand acts: under a SpidarG, as the first hand there. Elsewhere it
// reports why the hand does not act.
#pragma once

#include <godot_cpp/variant/packed_string_array.hpp>

class SpidarGHand;

namespace spidar {

class HandPlace {
public:
    // Returns the warnings for the editor.
    [[nodiscard]] static godot::PackedStringArray warnings(const SpidarGHand &hand);

    // Called in a running scene when the hand gets a new parent.
    void entered(const SpidarGHand &hand);
    // Called in each physics frame under a device. Reports once what keeps the hand from acting.
    [[nodiscard]] bool may_act(const SpidarGHand &hand);

private:
    bool told_ = false;
};

} // namespace spidar
