// SpidarGConfig: a resource that describes a device and how it is driven.
#pragma once

#include <string>

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/vector3.hpp>

#include "core/presets/presets.h"
#include "device/hid/hid_device_filter.h"
#include "device/serial/serial_transport.h"
#include "device/settings/servo_settings.h"
#include "device/simulation/simulated_plant.h"
#include "godot/base/resource_field.h"

// Value of SpidarGConfig.preset for a crossed grip whose sizes frame_size and pole_half_length
// give. Value k above 0 is the k-th device of core/presets/presets.h.
inline constexpr int kPresetCustom = 0;

class SpidarGConfig : public godot::Resource {
    GDCLASS(SpidarGConfig, godot::Resource)
    SPIDAR_G_CHECKED_CALLS

public:
    // What closes the fingers of a rigid grip.
    enum GraspSource { GRASP_AUTOMATIC, GRASP_BUTTON, GRASP_ACTION, GRASP_SENSOR };
    enum Transport { TRANSPORT_AUTOMATIC, TRANSPORT_SIMULATED, TRANSPORT_DEVICE, TRANSPORT_SERIAL };

    SPIDAR_G_REVISION;

    // Frame and grip.
    SPIDAR_G_FIELD(int, preset, kPresetCustom);
    SPIDAR_G_FIELD(godot::Vector3, frame_size, godot::Vector3(0.48F, 0.48F, 0.48F));
    SPIDAR_G_FIELD(double, pole_half_length, spidar::kPaperPoleHalfLength_m);
    SPIDAR_G_ARRAY_FIELD(godot::String, device_name);

    // Selection of the device. A number of 0 and an empty serial accept every device.
    SPIDAR_G_FIELD(int, transport, TRANSPORT_AUTOMATIC);
    SPIDAR_G_FIELD(godot::String, device_product, "SPIDAR-G");
    SPIDAR_G_ARRAY_FIELD(godot::String, device_serial);
    SPIDAR_G_FIELD(int, device_vendor_id, 0);
    SPIDAR_G_FIELD(int, device_product_id, 0);
    // Serial motor boards.
    SPIDAR_G_ARRAY_FIELD(godot::String, serial_port);
    // For each string: board, motor, sign of the counts, sign of the current. Empty: in order.
    SPIDAR_G_ARRAY_FIELD(godot::PackedInt32Array, serial_motors);
    SPIDAR_G_FIELD(double, serial_units_per_ampere, 0.0); // 0: the preset's value
    SPIDAR_G_FIELD(int, serial_most_units, spidar::SerialTransportSettings{}.most_units);
    SPIDAR_G_LIVE_FIELD(int, button_device, 16); // ids 0 to 15 are Godot's own joypads

    // Servo loop.
    SPIDAR_G_FIELD(int, rate_hz, 1000);
    SPIDAR_G_FIELD(double, velocity_cutoff_hz, 60.0);

    // Rendering.
    SPIDAR_G_FIELD(double, string_resonance_hz, spidar::RenderSettings{}.string_resonance_hz);
    SPIDAR_G_FIELD(double, delay_compensation, spidar::RenderSettings{}.delay_compensation_s);
    SPIDAR_G_FIELD(double, link_latency, spidar::RenderSettings{}.latency_s);
    SPIDAR_G_LIVE_FIELD(double, max_stiffness, spidar::RenderSettings{}.max_stiffness_n_m);
    SPIDAR_G_LIVE_FIELD(double, max_turn_stiffness,
                        spidar::RenderSettings{}.max_turn_stiffness_nm_rad);
    SPIDAR_G_LIVE_FIELD(double, max_grasp_stiffness,
                        spidar::RenderSettings{}.max_grasp_stiffness_nm_rad);
    SPIDAR_G_FIELD(double, compensated_mass, spidar::RenderSettings{}.compensated_mass_kg);
    SPIDAR_G_FIELD(double, compensated_friction, spidar::RenderSettings{}.compensated_friction_n);
    SPIDAR_G_FIELD(double, compensated_viscous, spidar::RenderSettings{}.compensated_viscous_n_s_m);

    // Tensions.
    SPIDAR_G_FIELD(double, tension_min, spidar::TensionSettings{}.min_tension_n);
    SPIDAR_G_FIELD(double, tension_reference, spidar::TensionSettings{}.reference_tension_n);
    SPIDAR_G_FIELD(double, tension_max, spidar::TensionSettings{}.max_tension_n);
    SPIDAR_G_FIELD(double, moment_weight, spidar::TensionSettings{}.weight_moment_per_m);
    SPIDAR_G_FIELD(double, ridge, spidar::TensionSettings{}.ridge);
    SPIDAR_G_FIELD(double, reference_weight, spidar::TensionSettings{}.reference_weight);
    SPIDAR_G_FIELD(double, change_weight, spidar::TensionSettings{}.change_weight);

    // Safety.
    SPIDAR_G_FIELD(double, tension_slew, spidar::SafetySettings{}.tension_slew_n_per_ms);
    SPIDAR_G_FIELD(double, arming_time, spidar::SafetySettings{}.arming_time_s);
    SPIDAR_G_LIVE_FIELD(double, max_force, spidar::SafetySettings{}.max_force_n);
    SPIDAR_G_LIVE_FIELD(double, max_moment, spidar::SafetySettings{}.max_moment_nm);
    SPIDAR_G_LIVE_FIELD(double, max_grasp_torque, spidar::SafetySettings{}.max_grasp_torque_nm);

    // Grasp. Angles are in radians here and in degrees in the inspector.
    SPIDAR_G_FIELD(double, grasp_enter_angle, spidar::GraspSettings{}.enter_rad);
    SPIDAR_G_FIELD(double, grasp_leave_angle, spidar::GraspSettings{}.leave_rad);
    SPIDAR_G_FIELD(double, over_closed_angle, spidar::GraspSettings{}.over_closed_rad);
    SPIDAR_G_FIELD(double, over_closed_leave_angle, spidar::GraspSettings{}.over_closed_leave_rad);
    SPIDAR_G_FIELD(double, grasp_dwell, spidar::GraspSettings{}.dwell_s);
    SPIDAR_G_LIVE_FIELD(double, jaw_open, 0.08);
    SPIDAR_G_LIVE_FIELD(double, jaw_closed_angle, 50.0 * spidar::kDegree_rad);

    // Fingers of a rigid grip. grasp_sensor_open and grasp_sensor_closed: readings of the sensor.
    SPIDAR_G_FIELD(int, grasp_source, GRASP_AUTOMATIC);
    SPIDAR_G_FIELD(int, grasp_button, -1);
    SPIDAR_G_FIELD(godot::String, grasp_action, "spidar_g_grasp");
    SPIDAR_G_FIELD(int, grasp_sensor, 0);
    SPIDAR_G_FIELD(double, grasp_sensor_open, 0.0);
    SPIDAR_G_FIELD(double, grasp_sensor_closed, 1000.0);

    // Simulated device.
    SPIDAR_G_FIELD(bool, simulated_elastic, true);
    SPIDAR_G_FIELD(double, simulated_string_stiffness,
                   spidar::PlantSettings{}.string_stiffness_ea_n);
    SPIDAR_G_FIELD(double, simulated_friction, spidar::PlantSettings{}.coulomb_friction_n);
    SPIDAR_G_LIVE_FIELD(int, simulated_hand_firmness,
                        static_cast<int>(spidar::HandFirmness::normal));
    // Errors of the simulated device, which a calibration measures: 8 values, or none.
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, simulated_offset_errors); // m
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, simulated_gain_errors);   // relative
    SPIDAR_G_ARRAY_FIELD(godot::PackedFloat64Array, simulated_tension_gains); // real / commanded

public:
    // Returns an empty string when the config is usable, else one sentence with field, value, unit
    // and remedy.
    [[nodiscard]] godot::String get_problem() const;
    // Returns the size of the preset's frame, or frame_size if the preset is Custom (unit: m).
    [[nodiscard]] godot::Vector3 get_effective_frame_size() const;
    // Returns the pole half length of the preset, or pole_half_length if it is Custom (unit: m).
    [[nodiscard]] double get_effective_pole_half_length() const;
    [[nodiscard]] bool has_rigid_grip() const;
    // Returns whether the strings of this frame and grip can hold and move the grip, and why not
    // (core/analysis/geometry_report.h).
    [[nodiscard]] godot::Dictionary check_geometry() const;

    // Reports a value of the wrong type; the property keeps its old value.
    void refuse(const std::string &message) const;

    // Returns the settings of the servo loop without the calibration.
    [[nodiscard]] spidar::ServoSettings servo_settings() const;
    [[nodiscard]] spidar::PlantSettings plant_settings() const;
    // Returns the filter that selects the USB device.
    [[nodiscard]] spidar::HidDeviceFilter hid_filter() const;
    // Returns port, motors and units. The guard's path stays empty: guard_beside_library().
    [[nodiscard]] spidar::SerialTransportSettings serial_settings() const;
    // Returns how far grasp_action is pressed, 0 to 1; 0 if the fingers do not follow the action.
    [[nodiscard]] double grasp_action_strength() const;
    // Puts "SpidarGConfig." before a problem that begins with the name of the setting serial_port.
    [[nodiscard]] static std::string told_of(const std::string &problem);
    // Returns the first problem that only this resource checks. validate() of ServoSettings and of
    // PlantSettings check the rest.
    [[nodiscard]] std::string own_problem() const;

    // Returns the jaw opening (unit: device m). It falls linearly from jaw_open at angle 0 to 0 at
    // jaw_closed_angle and stays 0 beyond.
    [[nodiscard]] double jaw_gap(double grasp_angle_rad) const;
    // Inverse of jaw_gap() where that is above 0.
    [[nodiscard]] double grasp_angle_for_gap(double gap_m) const;

    // In the editor, adds suggestions for device_serial and serial_port: what is plugged in.
    void _validate_property(godot::PropertyInfo &property) const;

private:
    // Returns the device of preset_, which must not be Custom.
    [[nodiscard]] spidar::DevicePreset preset_device() const;
    [[nodiscard]] std::string serial_problem() const;
    [[nodiscard]] std::string grasp_problem() const;
    [[nodiscard]] bool has_grasp_action() const;
    [[nodiscard]] bool grasp_from(GraspSource source) const;
    [[nodiscard]] spidar::FingerSettings finger_settings() const;
    static void bind_grasp();

protected:
    static void _bind_methods();
};

VARIANT_ENUM_CAST(SpidarGConfig::Transport);
VARIANT_ENUM_CAST(SpidarGConfig::GraspSource);
