// Grasp settings of a SpidarGConfig: when the poles count as closed, and what closes the fingers of
// a rigid grip.
#include <string>

#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_map.hpp>

#include "godot/settings/spidar_g_config.h"

using godot::PROPERTY_HINT_NONE;
using godot::PROPERTY_HINT_RANGE;
using godot::Variant;

namespace {

constexpr int kAnyButton = -1;
constexpr int kMostButton = 7;

} // namespace

std::string SpidarGConfig::grasp_problem() const {
    if (grasp_source_ < GRASP_AUTOMATIC || grasp_source_ > GRASP_SENSOR) {
        return "SpidarGConfig.grasp_source = " + std::to_string(grasp_source_) +
               ": choose Automatic (0), Button (1), Action (2) or Sensor (3).";
    }
    if (grasp_button_ < kAnyButton || grasp_button_ > kMostButton) {
        return "SpidarGConfig.grasp_button = " + std::to_string(grasp_button_) +
               ": choose a button of the device, 0 to 7, or -1 for any button.";
    }
    if (grasp_source_ == GRASP_ACTION && !has_grasp_action()) {
        return "SpidarGConfig.grasp_action = \"" + std::string(grasp_action_.utf8().get_data()) +
               "\": the project has no such action. Add it in Project Settings, Input Map, or name "
               "another one.";
    }
    if (grasp_sensor_ < 0 || grasp_sensor_ >= spidar::kSensorCount) {
        return "SpidarGConfig.grasp_sensor = " + std::to_string(grasp_sensor_) +
               ": choose a sensor of the device, 0 to 7.";
    }
    return {};
}

bool SpidarGConfig::has_grasp_action() const {
    return !grasp_action_.is_empty() &&
           godot::InputMap::get_singleton()->has_action(godot::StringName(grasp_action_));
}

bool SpidarGConfig::grasp_from(GraspSource source) const {
    return grasp_source_ == GRASP_AUTOMATIC || grasp_source_ == source;
}

double SpidarGConfig::grasp_action_strength() const {
    if (!grasp_from(GRASP_ACTION) || !has_grasp_action()) {
        return 0.0;
    }
    return static_cast<double>(
        godot::Input::get_singleton()->get_action_strength(godot::StringName(grasp_action_)));
}

spidar::FingerSettings SpidarGConfig::finger_settings() const {
    constexpr unsigned kAllButtons = 0xFFU;
    const unsigned mask =
        grasp_button_ < 0 ? kAllButtons : 1U << static_cast<unsigned>(grasp_button_);
    spidar::FingerSettings fingers;
    fingers.button_mask =
        grasp_from(GRASP_BUTTON) ? static_cast<std::uint8_t>(mask) : std::uint8_t{0};
    fingers.by_game = grasp_from(GRASP_ACTION);
    fingers.sensor = grasp_source_ == GRASP_SENSOR ? grasp_sensor_ : -1;
    fingers.sensor_open = grasp_sensor_open_;
    fingers.sensor_closed = grasp_sensor_closed_;
    fingers.closed_rad = jaw_closed_angle_;
    return fingers;
}

void SpidarGConfig::bind_grasp() {
    using Self = SpidarGConfig;
    const Variant::Type real = Variant::FLOAT;

    ADD_GROUP("Grasp", "");
    SPIDAR_G_BIND_FIELD(Self, real, grasp_enter_angle, PROPERTY_HINT_RANGE,
                        "-90,90,0.1,radians_as_degrees");
    SPIDAR_G_BIND_FIELD(Self, real, grasp_leave_angle, PROPERTY_HINT_RANGE,
                        "-90,90,0.1,radians_as_degrees");
    SPIDAR_G_BIND_FIELD(Self, real, over_closed_angle, PROPERTY_HINT_RANGE,
                        "-90,90,0.1,radians_as_degrees");
    SPIDAR_G_BIND_FIELD(Self, real, over_closed_leave_angle, PROPERTY_HINT_RANGE,
                        "-90,90,0.1,radians_as_degrees");
    SPIDAR_G_BIND_FIELD(Self, real, grasp_dwell, PROPERTY_HINT_RANGE,
                        "0,0.5,0.001,or_greater,suffix:s");
    SPIDAR_G_BIND_FIELD(Self, real, jaw_open, PROPERTY_HINT_RANGE, "0.001,0.999,0.001,suffix:m");
    SPIDAR_G_BIND_FIELD(Self, real, jaw_closed_angle, PROPERTY_HINT_RANGE,
                        "0.6,85.9,0.1,radians_as_degrees");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, grasp_source, godot::PROPERTY_HINT_ENUM,
                        "Automatic,Button,Action,Sensor");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, grasp_button, PROPERTY_HINT_RANGE, "-1,7,1");
    SPIDAR_G_BIND_FIELD(Self, Variant::STRING, grasp_action, PROPERTY_HINT_NONE, "");
    SPIDAR_G_BIND_FIELD(Self, Variant::INT, grasp_sensor, PROPERTY_HINT_RANGE, "0,7,1");
    SPIDAR_G_BIND_FIELD(Self, real, grasp_sensor_open, PROPERTY_HINT_RANGE, "-32768,32767,1");
    SPIDAR_G_BIND_FIELD(Self, real, grasp_sensor_closed, PROPERTY_HINT_RANGE, "-32768,32767,1");
    BIND_ENUM_CONSTANT(GRASP_AUTOMATIC);
    BIND_ENUM_CONSTANT(GRASP_BUTTON);
    BIND_ENUM_CONSTANT(GRASP_ACTION);
    BIND_ENUM_CONSTANT(GRASP_SENSOR);
}
