#include "godot/surface/spidar_g_material.h"

#include <algorithm>

#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "core/base/describe_value.h"
#include "godot/base/resource_field.h"
#include "godot/base/type_conversions.h"
#include "godot/surface/image_relief.h"

void SpidarGMaterial::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGMaterial." + message));
}

void SpidarGMaterial::take(const char *name, double value, double least, double most,
                           const char *unit, double &kept) {
    if (value == kNotSaid && least == kNotSaid) {
        // The default -1 is in use: there is no value to check.
    } else if (const std::string problem =
                   spidar::range_sentence({name, value, unit, std::max(least, 0.0), most});
               !problem.empty()) {
        refuse(problem + (least == kNotSaid ? " With -1 the physics material applies." : "") +
               " The old value stays.");
        return;
    }
    if (value != kept) {
        kept = value;
        emit_changed();
    }
}

void SpidarGMaterial::set_stick_slip(bool wanted) {
    if (wanted != stick_slip_) {
        stick_slip_ = wanted;
        emit_changed();
    }
}

void SpidarGMaterial::set_texture_direction(const godot::Vector3 &direction) {
    if (!direction.is_finite()) {
        refuse("texture_direction is not finite: give a direction in the body's frame, or zero for "
               "pits. The old value stays.");
        return;
    }
    if (direction != texture_direction_) {
        texture_direction_ = direction;
        emit_changed();
    }
}

void SpidarGMaterial::set_texture_image(const godot::Ref<godot::Texture2D> &image) {
    if (image == texture_image_) {
        return;
    }
    const godot::Callable listener = callable_mp(this, &SpidarGMaterial::forget_relief);
    if (texture_image_.is_valid()) {
        texture_image_->disconnect("changed", listener);
    }
    texture_image_ = image;
    if (texture_image_.is_valid()) {
        texture_image_->connect("changed", listener);
    }
    forget_relief();
}

void SpidarGMaterial::forget_relief() {
    relief_is_known_ = false;
    emit_changed();
}

std::shared_ptr<const spidar::CookedShape> SpidarGMaterial::relief() const {
    if (!relief_is_known_) {
        relief_is_known_ = true;
        relief_ = nullptr;
        if (texture_image_.is_valid()) {
            std::string problem;
            relief_ = spidar::relief_of(*texture_image_.ptr(), problem);
            if (!problem.empty()) {
                refuse("texture_image " + problem);
            }
        }
    }
    return relief_;
}

spidar::SurfaceTraits SpidarGMaterial::traits() const {
    spidar::SurfaceTraits traits;
    traits.static_friction = std::max(static_friction_, 0.0);
    traits.catches_again = stick_slip_;
    traits.adhesion_n = adhesion_;
    traits.magnet_n = magnet_force_;
    traits.magnet_range_m = magnet_range_;
    if (texture_wavelength_ > 0.0) {
        const godot::Vector3 across = texture_direction_.normalized();
        traits.texture = {texture_wavelength_, texture_depth_, spidar::to_core(across),
                          relief().get()};
    }
    return traits;
}

void SpidarGMaterial::_bind_methods() {
    using Self = SpidarGMaterial;
    constexpr auto real = godot::Variant::FLOAT;
    ADD_GROUP("Press", "");
    SPIDAR_G_BIND_FIELD(Self, real, stiffness, godot::PROPERTY_HINT_RANGE,
                        "0,2000,1,or_greater,suffix:N/m");
    SPIDAR_G_BIND_FIELD(Self, real, damping, godot::PROPERTY_HINT_RANGE,
                        "0,5,0.1,or_greater,suffix:N s/m");
    SPIDAR_G_BIND_FIELD(Self, real, squeeze_stiffness, godot::PROPERTY_HINT_RANGE,
                        "0,0.4,0.01,or_greater,suffix:N m/rad");
    ADD_GROUP("Slide", "");
    SPIDAR_G_BIND_FIELD(Self, real, dynamic_friction, godot::PROPERTY_HINT_RANGE,
                        "-1,2,0.01,or_greater");
    SPIDAR_G_BIND_FIELD(Self, real, static_friction, godot::PROPERTY_HINT_RANGE,
                        "-1,2,0.01,or_greater");
    spidar::bind_checked<&Self::set_stick_slip, "", "set_stick_slip", "stick_slip">();
    godot::ClassDB::bind_method(godot::D_METHOD("is_stick_slip"), &Self::is_stick_slip);
    ADD_PROPERTY(godot::PropertyInfo(godot::Variant::BOOL, "stick_slip"), "set_stick_slip",
                 "is_stick_slip");
    ADD_GROUP("Pull", "");
    SPIDAR_G_BIND_FIELD(Self, real, adhesion, godot::PROPERTY_HINT_RANGE,
                        "0,5,0.05,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, magnet_force, godot::PROPERTY_HINT_RANGE,
                        "0,5,0.05,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, magnet_range, godot::PROPERTY_HINT_RANGE,
                        "0,0.1,0.001,or_greater,suffix:m");
    ADD_GROUP("Texture", "texture_");
    SPIDAR_G_BIND_FIELD(Self, real, texture_wavelength, godot::PROPERTY_HINT_RANGE,
                        "0,0.05,0.0001,or_greater,suffix:m");
    SPIDAR_G_BIND_FIELD(Self, real, texture_depth, godot::PROPERTY_HINT_RANGE,
                        "0,0.002,0.00001,or_greater,suffix:m");
    spidar::bind_checked<&Self::set_texture_image, "", "set_texture_image", "texture_image">();
    godot::ClassDB::bind_method(godot::D_METHOD("get_texture_image"), &Self::get_texture_image);
    ADD_PROPERTY(godot::PropertyInfo(godot::Variant::OBJECT, "texture_image",
                                     godot::PROPERTY_HINT_RESOURCE_TYPE, "Texture2D"),
                 "set_texture_image", "get_texture_image");
    spidar::bind_checked<&Self::set_texture_direction, "", "set_texture_direction",
                         "texture_direction">();
    godot::ClassDB::bind_method(godot::D_METHOD("get_texture_direction"),
                                &Self::get_texture_direction);
    ADD_PROPERTY(godot::PropertyInfo(godot::Variant::VECTOR3, "texture_direction"),
                 "set_texture_direction", "get_texture_direction");
}
