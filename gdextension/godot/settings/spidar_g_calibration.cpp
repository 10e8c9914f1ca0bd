#include "godot/settings/spidar_g_calibration.h"

#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"

namespace {

// Copies 8 values, or none when the array is empty. Returns the problem, or an empty string.
template <typename Packed, typename Value>
std::string copy_eight(const char *field, const Packed &from,
                       std::array<Value, spidar::kStringCount> &to) {
    if (from.size() == 0) {
        return {};
    }
    if (from.size() != spidar::kStringCount) {
        return std::string("SpidarGCalibration.") + field + " has " + std::to_string(from.size()) +
               " values: give 8, one per string, or none for the ideal device.";
    }
    const auto *values = from.ptr();
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] = values[i];
    }
    return {};
}

godot::PackedFloat64Array unless_zero(const spidar::StringArray &values) {
    return values == spidar::StringArray{} ? godot::PackedFloat64Array() : spidar::to_godot(values);
}

} // namespace

void SpidarGCalibration::set_corrections(const spidar::LengthCorrections &known) {
    set_winding_curvatures(unless_zero(known.winding_curvature_1_m));
    set_string_stiffnesses(unless_zero(known.axial_stiffness_n));
    set_hidden_lengths(unless_zero(known.hidden_length_m));
    set_calibration_tensions(unless_zero(known.calibration_tension_n));
}

std::string SpidarGCalibration::apply_to(spidar::StringCalibration &ideal) const {
    std::string problem = copy_eight("string_offsets", string_offsets_, ideal.offset_m);
    if (problem.empty()) {
        problem = copy_eight("string_scales", string_scales_, ideal.scale_m_per_count);
    }
    return problem.empty() ? copy_eight("zero_counts", zero_counts_, ideal.zero_count) : problem;
}

std::string SpidarGCalibration::apply_to(spidar::ServoSettings &settings) const {
    spidar::ServoSettings changed = settings;
    std::string problem = apply_to(changed.strings);
    const auto also = [&problem](const std::string &next) {
        if (problem.empty()) {
            problem = next;
        }
    };
    spidar::LengthCorrections &corrections = changed.corrections;
    also(copy_eight("winding_curvatures", winding_curvatures_, corrections.winding_curvature_1_m));
    also(copy_eight("string_stiffnesses", string_stiffnesses_, corrections.axial_stiffness_n));
    also(copy_eight("hidden_lengths", hidden_lengths_, corrections.hidden_length_m));
    also(copy_eight("calibration_tensions", calibration_tensions_,
                    corrections.calibration_tension_n));
    also(copy_eight("effective_radii", effective_radii_, changed.motors.effective_radius_m));
    also(copy_eight("torque_constants", torque_constants_, changed.motors.torque_constant_nm_a));
    also(copy_eight("tension_gains", tension_gains_, changed.motors.tension_gain));
    also(copy_eight("max_currents", max_currents_, changed.motors.max_current_a));
    also(spidar::validate(changed.strings));
    also(spidar::validate(changed.corrections));
    also(spidar::validate(changed.motors));
    if (problem.empty()) {
        settings = changed;
    }
    return problem;
}

std::string SpidarGCalibration::strings_of(const godot::Ref<SpidarGCalibration> &given,
                                           const spidar::FrameGeometry &frame,
                                           const spidar::GripGeometry &grip,
                                           const spidar::CountArray &home, double metres_per_count,
                                           spidar::StringCalibration &strings) {
    spidar::StringCalibration found = spidar::calibrate_at_home(
        spidar::string_lengths(frame, grip, spidar::rest_pose(grip)), home, metres_per_count);
    std::string problem = given.is_valid() ? given->apply_to(found) : std::string();
    problem = problem.empty() ? spidar::validate(found) : problem;
    if (problem.empty()) {
        strings = found;
    }
    return problem;
}

void SpidarGCalibration::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGCalibration." + message));
}

godot::String SpidarGCalibration::get_problem() const {
    // Any valid settings suffice: only the calibration's own arrays can be wrong.
    spidar::ServoSettings settings;
    settings.strings = spidar::calibrate_at_home(
        spidar::string_lengths(settings.frame, settings.grip, spidar::rest_pose(settings.grip)), {},
        spidar::kPaperMetresPerCount);
    return spidar::to_godot(apply_to(settings));
}

void SpidarGCalibration::_bind_methods() {
    using Self = SpidarGCalibration;
    using godot::PROPERTY_HINT_NONE;
    const godot::Variant::Type reals = godot::Variant::PACKED_FLOAT64_ARRAY;
    ADD_GROUP("Strings", "");
    SPIDAR_G_BIND_FIELD(Self, reals, string_offsets, PROPERTY_HINT_NONE, "suffix:m");
    SPIDAR_G_BIND_FIELD(Self, reals, string_scales, PROPERTY_HINT_NONE, "suffix:m/count");
    SPIDAR_G_BIND_FIELD(Self, godot::Variant::PACKED_INT32_ARRAY, zero_counts, PROPERTY_HINT_NONE,
                        "");
    SPIDAR_G_BIND_FIELD(Self, reals, winding_curvatures, PROPERTY_HINT_NONE, "suffix:1/m");
    SPIDAR_G_BIND_FIELD(Self, reals, string_stiffnesses, PROPERTY_HINT_NONE, "suffix:N");
    SPIDAR_G_BIND_FIELD(Self, reals, hidden_lengths, PROPERTY_HINT_NONE, "suffix:m");
    SPIDAR_G_BIND_FIELD(Self, reals, calibration_tensions, PROPERTY_HINT_NONE, "suffix:N");
    ADD_GROUP("Motors", "");
    SPIDAR_G_BIND_FIELD(Self, reals, effective_radii, PROPERTY_HINT_NONE, "suffix:m");
    SPIDAR_G_BIND_FIELD(Self, reals, torque_constants, PROPERTY_HINT_NONE, "suffix:N m/A");
    SPIDAR_G_BIND_FIELD(Self, reals, tension_gains, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, reals, max_currents, PROPERTY_HINT_NONE, "suffix:A");

    godot::ClassDB::bind_method(godot::D_METHOD("get_problem"), &SpidarGCalibration::get_problem);
}
