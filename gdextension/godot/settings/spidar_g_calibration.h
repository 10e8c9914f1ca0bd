// SpidarGCalibration: the measured properties of one individual device: string offsets and scales,
// winding and stretch, motor gains.
#pragma once

#include <string>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/string.hpp>

#include "device/settings/servo_settings.h"
#include "godot/base/resource_field.h"

// Each array holds 8 values, for strings 0 to 7, or is empty. In place of an empty array, the
// values of the ideal device apply (no winding, no stretch).
class SpidarGCalibration : public godot::Resource {
    GDCLASS(SpidarGCalibration, godot::Resource)
    SPIDAR_G_CHECKED_CALLS
    SPIDAR_G_REVISION;
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, string_offsets); // m, at the zero count
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, string_scales);  // m per count, signed
    SPIDAR_G_ARRAY_FIELD(godot::PackedInt32Array, zero_counts);
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, winding_curvatures);   // 1/m
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, string_stiffnesses);   // EA in N
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, hidden_lengths);       // m
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, calibration_tensions); // N
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, effective_radii);      // m
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, torque_constants);     // N m/A
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, tension_gains);        // real / commanded
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, max_currents);         // A

public:
    [[nodiscard]] godot::String get_problem() const;
    // Reports a value of the wrong type; the property keeps its old value.
    void refuse(const std::string &message) const;

    // Sets winding and stretch. An array whose values are all zero becomes empty.
    void set_corrections(const spidar::LengthCorrections &known);

    // Overwrites `settings` with the arrays that are not empty. Returns an empty string, or one
    // sentence with the problem; `settings` is then unchanged.
    [[nodiscard]] std::string apply_to(spidar::ServoSettings &settings) const;

    // Sets `strings` to offsets, scales and zero counts for a device with this frame and grip whose
    // counts at the home pose are `home`: those of the ideal device, overwritten by `given` (may be
    // null). Returns an empty string, or the problem; `strings` is then unchanged.
    [[nodiscard]] static std::string
    strings_of(const godot::Ref<SpidarGCalibration> &given, const spidar::FrameGeometry &frame,
               const spidar::GripGeometry &grip, const spidar::CountArray &home,
               double metres_per_count, spidar::StringCalibration &strings);

protected:
    static void _bind_methods();

private:
    [[nodiscard]] std::string apply_to(spidar::StringCalibration &ideal) const;
};
