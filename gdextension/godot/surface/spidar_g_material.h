// SpidarGMaterial: how a surface feels. Where other values come from if this material does not set
// them, docs/reference/surfaces.md says. The class reference is
// gdextension/doc_classes/SpidarGMaterial.xml.
#pragma once

#include <memory>
#include <string>

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/vector3.hpp>

#include "device/contact/proxy/surface_traits.h"
#include "godot/base/strict.h"

// A number with setter and getter. The setter refuses a value outside m_least to m_most, and the
// old value stays.
#define SPIDAR_G_MATERIAL_NUMBER(m_name, m_default, m_least, m_most, m_unit)                       \
public:                                                                                            \
    void set_##m_name(double p_value) {                                                            \
        take(#m_name, p_value, m_least, m_most, m_unit, m_name##_);                                \
    }                                                                                              \
    [[nodiscard]] double get_##m_name() const {                                                    \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    double m_name##_ = m_default

class SpidarGMaterial : public godot::Resource {
    GDCLASS(SpidarGMaterial, godot::Resource)
    SPIDAR_G_CHECKED_CALLS

    // In these three, 0 means that this material sets no value.
    SPIDAR_G_MATERIAL_NUMBER(stiffness, 0.0, 0.0, 1.0e4, "N/m");
    SPIDAR_G_MATERIAL_NUMBER(damping, 0.0, 0.0, 100.0, "N s/m");
    SPIDAR_G_MATERIAL_NUMBER(squeeze_stiffness, 0.0, 0.0, 10.0, "N m/rad");
    // In the two frictions, kNotSaid means that this material sets no value.
    SPIDAR_G_MATERIAL_NUMBER(dynamic_friction, kNotSaid, kNotSaid, 10.0, "");
    SPIDAR_G_MATERIAL_NUMBER(static_friction, kNotSaid, kNotSaid, 10.0, "");
    SPIDAR_G_MATERIAL_NUMBER(adhesion, 0.0, 0.0, 20.0, "N");
    SPIDAR_G_MATERIAL_NUMBER(magnet_force, 0.0, 0.0, 20.0, "N");
    SPIDAR_G_MATERIAL_NUMBER(magnet_range, 0.01, 0.0, 1.0, "m"); // of the scene
    SPIDAR_G_MATERIAL_NUMBER(texture_wavelength, 0.0, 0.0, 1.0, "m");
    SPIDAR_G_MATERIAL_NUMBER(texture_depth, 0.0, 0.0, 0.1, "m");

public:
    static constexpr double kNotSaid = -1.0;

    void set_stick_slip(bool wanted);
    [[nodiscard]] bool is_stick_slip() const { return stick_slip_; }
    void set_texture_direction(const godot::Vector3 &direction);
    [[nodiscard]] godot::Vector3 get_texture_direction() const { return texture_direction_; }

    // The luminance of each pixel is a height. Null: the texture has grooves or pits.
    void set_texture_image(const godot::Ref<godot::Texture2D> &image);
    [[nodiscard]] godot::Ref<godot::Texture2D> get_texture_image() const { return texture_image_; }
    // Returns the image as a shape of kind relief. Null without an image, with one that cannot be
    // used, or while the texture has none yet (NoiseTexture2D). The result of traits() points at
    // this shape. A changed texture makes a new shape.
    [[nodiscard]] std::shared_ptr<const spidar::CookedShape> relief() const;

    // Returns static friction (0: not set), stick-slip, adhesion, magnet and texture. Lengths are
    // in scene meters, directions in the body's frame.
    [[nodiscard]] spidar::SurfaceTraits traits() const;

    // Reports a refused value in the output; the property keeps its old value.
    void refuse(const std::string &message) const;

protected:
    static void _bind_methods();

private:
    void take(const char *name, double value, double least, double most, const char *unit,
              double &kept);

    void forget_relief();

    bool stick_slip_ = false;
    godot::Vector3 texture_direction_;
    godot::Ref<godot::Texture2D> texture_image_;
    // Result of relief(), which makes the shape when it is first needed.
    mutable std::shared_ptr<const spidar::CookedShape> relief_;
    mutable bool relief_is_known_ = false;
};
