// Where in the scene a hand acts: under a SpidarG, as the first hand there. Elsewhere it says why it does not.
#pragma once

#include <godot_cpp/variant/packed_string_array.hpp>

class SpidarGHand;

namespace spidar {

class HandPlace {
public:
    // For the editor.
    [[nodiscard]] static godot::PackedStringArray warnings(const SpidarGHand &hand);

    // In a running scene: under a new parent.
    void entered(const SpidarGHand &hand);
    // Each physics frame under a device. What keeps a hand from acting is told once.
    [[nodiscard]] bool may_act(const SpidarGHand &hand);

private:
    bool told_ = false;
};

} // namespace spidar
