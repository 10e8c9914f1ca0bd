#include "godot/settings/spidar_g_config.h"

#include <algorithm>
#include <cmath>

#include "core/analysis/geometry_report.h"
#include "godot/base/type_conversions.h"
#include "godot/settings/plugged_in_devices.h"

#include <glm/common.hpp>

#include <godot_cpp/classes/engine.hpp>

#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

using godot::PROPERTY_HINT_NONE;
using godot::PROPERTY_HINT_RANGE;
using godot::Variant;

namespace {

// Returns "name = value unit: remedy", the form of all messages of this resource.
std::string complaint(const char *field, double value, const char *unit, const char *remedy) {
    return std::string("SpidarGConfig.") + field + " = " + std::to_string(value) + " " + unit +
           ": " + remedy;
}

// Requires eight values, one per string, or none. Returns the problem, or an empty string.
std::string refuse_eight(const char *field, const godot::PackedFloat64Array &values, double low,
                         double high, const char *unit) {
    if (values.size() == 0) {
        return {};
    }
    if (values.size() != spidar::kStringCount) {
        return std::string("SpidarGConfig.") + field + " has " + std::to_string(values.size()) +
               " values: give 8, one per string, or none.";
    }
    for (int i = 0; i < spidar::kStringCount; ++i) {
        if (!(values[i] >= low && values[i] <= high)) {
            return std::string("SpidarGConfig.") + field + "[" + std::to_string(i) +
                   "] = " + std::to_string(values[i]) + " " + unit + ": give " +
                   std::to_string(low) + " to " + std::to_string(high) + ".";
        }
    }
    return {};
}

} // namespace

std::string SpidarGConfig::own_problem() const {
    for (int axis = 0; axis < 3; ++axis) {
        const double size = static_cast<double>(frame_size_[axis]);
        if (!(size > 0.0 && std::isfinite(size))) {
            const char *const fields[] = {"frame_size.x", "frame_size.y", "frame_size.z"};
            return complaint(fields[axis], size, "m",
                             "give the outer size of the frame along this axis, above 0.");
        }
    }
    if (transport_ < TRANSPORT_AUTOMATIC || transport_ > TRANSPORT_SERIAL) {
        return complaint("transport", transport_, "",
                         "choose Automatic (0), Simulated (1), Device (2) or Serial (3).");
    }
    for (std::string problem : {serial_problem(), grasp_problem()}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    constexpr int kLargestUsbNumber = 0xFFFF;
    if (device_vendor_id_ < 0 || device_vendor_id_ > kLargestUsbNumber) {
        return complaint("device_vendor_id", device_vendor_id_, "", "choose 0 (any) to 65535.");
    }
    if (device_product_id_ < 0 || device_product_id_ > kLargestUsbNumber) {
        return complaint("device_product_id", device_product_id_, "", "choose 0 (any) to 65535.");
    }
    if (preset_ < kPresetCustom || preset_ > spidar::kPresetCount) {
        return complaint("preset", preset_, "(index)", "choose a preset from the list, 0 to 6.");
    }
    if (rate_hz_ < 100 || rate_hz_ > 4000) {
        return complaint("rate_hz", rate_hz_, "Hz", "choose 100 to 4000 Hz.");
    }
    if (!(jaw_open_ > 0.0 && jaw_open_ < 1.0)) {
        return complaint("jaw_open", jaw_open_, "m",
                         "give the opening of the open jaws, above 0 m and below 1 m.");
    }
    if (!(jaw_closed_angle_ > 0.0 && jaw_closed_angle_ < 90.0 * spidar::kDegree_rad)) {
        return complaint("jaw_closed_angle", jaw_closed_angle_, "rad",
                         "give the angle of the closed jaws, 0.01 to 1.5 rad.");
    }
    constexpr double kMostOffset_m = 0.1;
    constexpr double kMostGain = 0.3;
    constexpr double kTensionGain = 0.2;
    std::string problem = refuse_eight("simulated_offset_errors", simulated_offset_errors_,
                                       -kMostOffset_m, kMostOffset_m, "m");
    if (problem.empty()) {
        problem = refuse_eight("simulated_gain_errors", simulated_gain_errors_, -kMostGain,
                               kMostGain, "(relative)");
    }
    if (problem.empty()) {
        problem = refuse_eight("simulated_tension_gains", simulated_tension_gains_, kTensionGain,
                               1.0 / kTensionGain, "(real / commanded)");
    }
    return problem;
}

void SpidarGConfig::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGConfig." + message));
}

godot::String SpidarGConfig::get_problem() const {
    std::string problem = own_problem();
    if (problem.empty()) {
        problem = spidar::validate(servo_settings());
    }
    if (problem.empty()) {
        problem = spidar::validate(plant_settings());
    }
    return spidar::to_godot(problem);
}

godot::Vector3 SpidarGConfig::get_effective_frame_size() const {
    if (preset_ <= kPresetCustom || preset_ > spidar::kPresetCount) {
        return frame_size_;
    }
    const spidar::DevicePreset device = preset_device();
    spidar::Vec3 low = device.frame.motors_m[0];
    spidar::Vec3 high = low;
    for (const spidar::Vec3 &motor : device.frame.motors_m) {
        low = glm::min(low, motor);
        high = glm::max(high, motor);
    }
    return spidar::to_godot(high - low);
}

double SpidarGConfig::get_effective_pole_half_length() const {
    return servo_settings().grip.pole_half_length_m;
}

spidar::DevicePreset SpidarGConfig::preset_device() const {
    return spidar::device_preset(static_cast<spidar::Preset>(preset_ - 1));
}

bool SpidarGConfig::has_rigid_grip() const {
    return preset_ != kPresetCustom && preset_device().grip.kind == spidar::GripKind::rigid;
}

void SpidarGConfig::_validate_property(godot::PropertyInfo &property) const {
    if (!godot::Engine::get_singleton()->is_editor_hint()) {
        return;
    }
    if (property.name == godot::StringName("serial_port")) {
        property.hint = godot::PROPERTY_HINT_ENUM_SUGGESTION;
        property.hint_string = spidar::to_godot(spidar::names_of_serial_ports());
    }
    if (property.name != godot::StringName("device_serial")) {
        return;
    }
    std::string serials;
    for (const spidar::HidDeviceInfo &device : spidar::plugged_in_devices()) {
        serials += (serials.empty() ? "" : ",") + spidar::name_of(device);
    }
    property.hint = godot::PROPERTY_HINT_ENUM_SUGGESTION;
    property.hint_string = spidar::to_godot(serials);
}

godot::Dictionary SpidarGConfig::check_geometry() const {
    godot::Dictionary told;
    godot::PackedStringArray complaints;
    const std::string problem = own_problem();
    if (!problem.empty()) {
        complaints.push_back(spidar::to_godot(problem));
        told["sound"] = false;
        told["complaints"] = complaints;
        return told;
    }
    const spidar::ServoSettings settings = servo_settings();
    const spidar::GeometryReport report =
        spidar::report_geometry(settings.frame, settings.grip, settings.tension.min_tension_n,
                                settings.tension.max_tension_n);
    for (const std::string &complaint : report.complaints) {
        complaints.push_back(spidar::to_godot(complaint));
    }
    told["sound"] = report.sound();
    told["degrees_of_freedom"] = report.degrees_of_freedom;
    told["rank"] = report.at_rest.rank;
    told["closed_at_rest"] = report.at_rest.closed;
    told["closure_share"] = report.closure_share;
    told["force_capacity_n"] = report.force_capacity_n;
    told["moment_capacity_nm"] = report.moment_capacity_nm;
    told["complaints"] = complaints;
    return told;
}

spidar::ServoSettings SpidarGConfig::servo_settings() const {
    spidar::ServoSettings settings;
    settings.rate_hz = rate_hz_;
    settings.velocity_cutoff_hz = velocity_cutoff_hz_;
    settings.frame = spidar::make_box_frame(0.5 * spidar::to_core(frame_size_));
    settings.grip.pole_half_length_m = pole_half_length_;
    double metres_per_count = spidar::kPaperMetresPerCount;
    double most_tension_n = tension_max_;
    if (preset_ != kPresetCustom) {
        const spidar::DevicePreset device = preset_device();
        settings.frame = device.frame;
        settings.grip = device.grip;
        metres_per_count = device.metres_per_count;
        most_tension_n = device.max_tension_n;
    }
    settings.strings = spidar::calibrate_at_home(
        spidar::string_lengths(settings.frame, settings.grip, spidar::rest_pose(settings.grip)), {},
        metres_per_count);
    settings.render.string_resonance_hz = string_resonance_hz_;
    settings.render.delay_compensation_s = delay_compensation_;
    settings.render.latency_s = link_latency_;
    settings.render.max_stiffness_n_m = max_stiffness_;
    settings.render.max_turn_stiffness_nm_rad = max_turn_stiffness_;
    settings.render.max_grasp_stiffness_nm_rad = max_grasp_stiffness_;
    settings.render.compensated_mass_kg = compensated_mass_;
    settings.render.compensated_friction_n = compensated_friction_;
    settings.render.compensated_viscous_n_s_m = compensated_viscous_;
    settings.tension.min_tension_n = tension_min_;
    settings.tension.reference_tension_n = tension_reference_;
    settings.tension.max_tension_n = std::min(tension_max_, most_tension_n);
    settings.tension.weight_moment_per_m = moment_weight_;
    settings.tension.weight_grasp_per_m = moment_weight_;
    settings.tension.ridge = ridge_;
    settings.tension.reference_weight = reference_weight_;
    settings.tension.change_weight = change_weight_;
    settings.safety.tension_slew_n_per_ms = tension_slew_;
    settings.safety.arming_time_s = arming_time_;
    settings.safety.max_force_n = max_force_;
    settings.safety.max_moment_nm = max_moment_;
    settings.safety.max_grasp_torque_nm = max_grasp_torque_;
    settings.grasp.enter_rad = grasp_enter_angle_;
    settings.grasp.leave_rad = grasp_leave_angle_;
    settings.grasp.over_closed_rad = over_closed_angle_;
    settings.grasp.over_closed_leave_rad = over_closed_leave_angle_;
    settings.grasp.dwell_s = grasp_dwell_;
    settings.fingers = finger_settings();
    return settings;
}

spidar::PlantSettings SpidarGConfig::plant_settings() const {
    const spidar::ServoSettings servo = servo_settings();
    spidar::PlantSettings plant;
    plant.frame = servo.frame;
    plant.grip = servo.grip;
    plant.metres_per_count = servo.strings.scale_m_per_count[0];
    plant.elastic = simulated_elastic_;
    plant.string_stiffness_ea_n = simulated_string_stiffness_;
    plant.coulomb_friction_n = simulated_friction_;
    // Zero friction means no friction at all: the rotors' viscous drag is removed too.
    if (simulated_friction_ == 0.0) {
        plant.viscous_friction_n_s_m = 0.0;
    }
    const int firmest = static_cast<int>(spidar::HandFirmness::firm);
    for (std::size_t i = 0; i < spidar::kStringCount; ++i) {
        const auto at = static_cast<std::int64_t>(i);
        if (simulated_offset_errors_.size() == spidar::kStringCount) {
            plant.length_offset_error_m[i] = simulated_offset_errors_[at];
        }
        if (simulated_gain_errors_.size() == spidar::kStringCount) {
            // More counts per meter: the string lies on a smaller radius, and so pulls harder.
            plant.length_gain_error[i] = simulated_gain_errors_[at];
            plant.motors.effective_radius_m[i] /= 1.0 + simulated_gain_errors_[at];
        }
        if (simulated_tension_gains_.size() == spidar::kStringCount) {
            plant.motors.tension_gain[i] = simulated_tension_gains_[at];
        }
    }
    plant.firmness =
        static_cast<spidar::HandFirmness>(std::clamp(simulated_hand_firmness_, 0, firmest));
    return plant;
}

spidar::HidDeviceFilter SpidarGConfig::hid_filter() const {
    spidar::HidDeviceFilter filter;
    filter.vendor_id = static_cast<std::uint16_t>(device_vendor_id_);
    filter.product_id = static_cast<std::uint16_t>(device_product_id_);
    filter.serial = device_serial_.utf8().get_data();
    filter.product = device_product_.utf8().get_data();
    return filter;
}

double SpidarGConfig::jaw_gap(double grasp_angle_rad) const {
    return std::max(0.0, jaw_open_ * (1.0 - grasp_angle_rad / jaw_closed_angle_));
}

double SpidarGConfig::grasp_angle_for_gap(double gap_m) const {
    return jaw_closed_angle_ * (1.0 - gap_m / jaw_open_);
}

void SpidarGConfig::_bind_methods() {
    using Self = SpidarGConfig;
    const Variant::Type real = Variant::FLOAT;

    ADD_GROUP("Device", "");
    SPIDAR_G_BIND_FIELD(Self, Variant::STRING, device_name, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, preset, godot::PROPERTY_HINT_ENUM,
                        "Custom,Paper,SpidarG6X3R,SpidarG6X3L,SpidarG6X5R,SpidarG6X5L,SpidarG6X4");
    SPIDAR_G_BIND_FIELD(Self, Variant::VECTOR3, frame_size, PROPERTY_HINT_NONE, "suffix:m");
    SPIDAR_G_BIND_FIELD(Self, real, pole_half_length, PROPERTY_HINT_RANGE,
                        "0.001,0.2,0.0001,or_greater,suffix:m");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, transport, godot::PROPERTY_HINT_ENUM,
                        "Automatic,Simulated,Device,Serial");
    SPIDAR_G_BIND_FIELD(Self, Variant::STRING, device_product, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, Variant::STRING, device_serial, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, device_vendor_id, PROPERTY_HINT_RANGE, "0,65535,1");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, device_product_id, PROPERTY_HINT_RANGE, "0,65535,1");
    SPIDAR_G_BIND_FIELD(Self, Variant::STRING, serial_port, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, Variant::PACKED_INT32_ARRAY, serial_motors, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, real, serial_units_per_ampere, PROPERTY_HINT_RANGE,
                        "0,10000,0.1,or_greater,suffix:units/A");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, serial_most_units, PROPERTY_HINT_RANGE, "1,4095,1");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, button_device, PROPERTY_HINT_RANGE, "0,31,1");
    ADD_GROUP("Servo Loop", "");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, rate_hz, PROPERTY_HINT_RANGE, "100,4000,1,suffix:Hz");
    SPIDAR_G_BIND_FIELD(Self, real, velocity_cutoff_hz, PROPERTY_HINT_RANGE, "1,1000,1,suffix:Hz");
    ADD_GROUP("Rendering", "");
    SPIDAR_G_BIND_FIELD(Self, real, string_resonance_hz, PROPERTY_HINT_RANGE,
                        "0,400,1,or_greater,suffix:Hz");
    SPIDAR_G_BIND_FIELD(Self, real, delay_compensation, PROPERTY_HINT_RANGE,
                        "0,0.02,0.0001,suffix:s");
    SPIDAR_G_BIND_FIELD(Self, real, link_latency, PROPERTY_HINT_RANGE, "0,0.05,0.0001,suffix:s");
    SPIDAR_G_BIND_FIELD(Self, real, max_stiffness, PROPERTY_HINT_RANGE,
                        "0,5000,1,or_greater,suffix:N/m");
    SPIDAR_G_BIND_FIELD(Self, real, max_turn_stiffness, PROPERTY_HINT_RANGE,
                        "0,10,0.01,or_greater,suffix:N m/rad");
    SPIDAR_G_BIND_FIELD(Self, real, max_grasp_stiffness, PROPERTY_HINT_RANGE,
                        "0,5,0.01,or_greater,suffix:N m/rad");
    SPIDAR_G_BIND_FIELD(Self, real, compensated_mass, PROPERTY_HINT_RANGE, "0,1,0.001,suffix:kg");
    SPIDAR_G_BIND_FIELD(Self, real, compensated_friction, PROPERTY_HINT_RANGE,
                        "0,0.5,0.001,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, compensated_viscous, PROPERTY_HINT_RANGE,
                        "0,1,0.001,suffix:N s/m");
    ADD_GROUP("Tensions", "");
    SPIDAR_G_BIND_FIELD(Self, real, tension_min, PROPERTY_HINT_RANGE,
                        "0,5,0.01,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, tension_reference, PROPERTY_HINT_RANGE,
                        "0,10,0.01,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, tension_max, PROPERTY_HINT_RANGE,
                        "0,30,0.1,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, moment_weight, PROPERTY_HINT_RANGE,
                        "0,200,0.1,or_greater,suffix:1/m");
    SPIDAR_G_BIND_FIELD(Self, real, ridge, PROPERTY_HINT_RANGE, "1e-12,0.1,1e-12,exp,or_greater");
    SPIDAR_G_BIND_FIELD(Self, real, reference_weight, PROPERTY_HINT_RANGE,
                        "0,0.1,1e-7,exp,or_greater");
    SPIDAR_G_BIND_FIELD(Self, real, change_weight, PROPERTY_HINT_RANGE, "0,1,1e-7,exp,or_greater");
    ADD_GROUP("Safety", "");
    SPIDAR_G_BIND_FIELD(Self, real, tension_slew, PROPERTY_HINT_RANGE,
                        "0.001,10,0.001,or_greater,suffix:N/ms");
    SPIDAR_G_BIND_FIELD(Self, real, arming_time, PROPERTY_HINT_RANGE,
                        "0.001,10,0.001,or_greater,suffix:s");
    SPIDAR_G_BIND_FIELD(Self, real, max_force, PROPERTY_HINT_RANGE, "0,40,0.1,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, max_moment, PROPERTY_HINT_RANGE,
                        "0,2,0.01,or_greater,suffix:N m");
    SPIDAR_G_BIND_FIELD(Self, real, max_grasp_torque, PROPERTY_HINT_RANGE,
                        "0,2,0.01,or_greater,suffix:N m");
    bind_grasp();
    ADD_GROUP("Simulated Device", "simulated_");
    SPIDAR_G_BIND_FIELD(Self, Variant::BOOL, simulated_elastic, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, real, simulated_string_stiffness, PROPERTY_HINT_RANGE,
                        "10,30000,10,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, real, simulated_friction, PROPERTY_HINT_RANGE,
                        "0,0.5,0.01,or_greater,suffix:N");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, simulated_hand_firmness, godot::PROPERTY_HINT_ENUM,
                        "Light,Normal,Firm");
    const Variant::Type reals = Variant::PACKED_FLOAT64_ARRAY;
    SPIDAR_G_BIND_FIELD(Self, reals, simulated_offset_errors, PROPERTY_HINT_NONE, "suffix:m");
    SPIDAR_G_BIND_FIELD(Self, reals, simulated_gain_errors, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, reals, simulated_tension_gains, PROPERTY_HINT_NONE, "");

    godot::ClassDB::bind_method(godot::D_METHOD("get_problem"), &SpidarGConfig::get_problem);
    godot::ClassDB::bind_method(godot::D_METHOD("get_effective_frame_size"),
                                &SpidarGConfig::get_effective_frame_size);
    godot::ClassDB::bind_method(godot::D_METHOD("get_effective_pole_half_length"),
                                &SpidarGConfig::get_effective_pole_half_length);
    godot::ClassDB::bind_method(godot::D_METHOD("has_rigid_grip"), &SpidarGConfig::has_rigid_grip);
    godot::ClassDB::bind_method(godot::D_METHOD("check_geometry"), &SpidarGConfig::check_geometry);
    BIND_ENUM_CONSTANT(TRANSPORT_AUTOMATIC);
    BIND_ENUM_CONSTANT(TRANSPORT_SIMULATED);
    BIND_ENUM_CONSTANT(TRANSPORT_DEVICE);
    BIND_ENUM_CONSTANT(TRANSPORT_SERIAL);
}
