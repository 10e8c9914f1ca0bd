// SpidarGSurface: gives its parent body a SpidarGMaterial, and emits signals when a hand begins and
// ends to touch the body or to slip on it. Main thread only. The class reference is
// gdextension/doc_classes/SpidarGSurface.xml.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/vector3.hpp>

#include "godot/surface/spidar_g_material.h"

class SpidarGSurface : public godot::Node {
    GDCLASS(SpidarGSurface, godot::Node)
    SPIDAR_G_CHECKED_CALLS

public:
    // Contact of a hand with the body in one physics tick.
    struct Touch {
        double force_n = 0.0;
        double slip_m_s = 0.0; // device m/s; 0: the hand does not slip
        godot::Vector3 point;  // world coordinates
    };

    // Returns the surface of the body with this instance id; null when the body has none.
    [[nodiscard]] static SpidarGSurface *of(std::uint64_t body);

    void set_material(const godot::Ref<SpidarGMaterial> &material);
    [[nodiscard]] godot::Ref<SpidarGMaterial> get_material() const { return material_; }

    // Called once per physics tick by each hand that touches the body, and once with zero force by
    // a hand that no longer does. Emits the signals for what changed since the last call.
    void note(godot::Object &hand, const Touch &touch);

    [[nodiscard]] bool is_touched() const { return !touches_.empty(); }
    // Returns the sum of Touch::force_n over all hands.
    [[nodiscard]] double get_touch_force() const;
    // Returns the largest Touch::slip_m_s of all hands.
    [[nodiscard]] double get_slip_speed() const;

    void refuse(const std::string &message) const;

    void _enter_tree() override;
    void _exit_tree() override;
    [[nodiscard]] godot::PackedStringArray _get_configuration_warnings() const override;
    [[nodiscard]] godot::PackedStringArray get_warnings() const {
        return _get_configuration_warnings();
    }

protected:
    static void _bind_methods();

private:
    struct ByHand {
        std::uint64_t hand = 0;
        Touch touch;
    };

    godot::Ref<SpidarGMaterial> material_;
    std::uint64_t body_ = 0;
    std::vector<ByHand> touches_; // one per hand that touches the surface now
};
