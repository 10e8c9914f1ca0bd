// Settings of a SpidarG from its resources and the project, and the editor's warnings.
#include "godot/device/spidar_g.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"
#include "godot/device/live_limits.h"

using godot::Ref;
using godot::String;
using godot::UtilityFunctions;

namespace {

// Largest deviation of the node's scale from 1 that counts as rounding.
constexpr double kNodeScaleTolerance = 1e-3;

} // namespace

void SpidarG::read_project() {
    options_ = spidar::project_options();
    const Ref<SpidarGConfig> config = spidar::project_config();
    if (config.is_valid()) {
        default_config_ = config;
    }
}

const SpidarGConfig &SpidarG::config_or_default() const {
    return config_.is_valid() ? *config_.ptr() : *default_config_.ptr();
}

Ref<SpidarGConfig> SpidarG::get_effective_config() const {
    return config_.is_valid() ? config_ : default_config_;
}

std::uint64_t SpidarG::resources_revision() const {
    return config_or_default().revision() +
           (calibration_.is_valid() ? calibration_->revision() : 0U);
}

bool SpidarG::change_live(const std::string &problem) {
    if (!loop_ || replay_ != nullptr || restart_pending_) {
        return false;
    }
    if (!problem.empty()) {
        refuse(problem + " The open device keeps its last good settings.");
        return true;
    }
    if (resources_revision() != opened_revision_) {
        return false;
    }
    want_limits(spidar::live_limits(settings_));
    if (simulated_ != nullptr) {
        simulated_->set_hand_firmness(plant_.firmness);
    }
    return true;
}

void SpidarG::want_limits(const spidar::LiveLimits &limits) {
    limits_from_ = spidar::between(limits_from_, limits_wanted_, limits_share_);
    limits_wanted_ = limits;
    limits_share_ = 0.0;
}

// A link that is slower than the config states makes every wall softer. A faster one makes none
// stiffer, since its echoes do not include the device's own delays.
void SpidarG::watch_latency() {
    constexpr double kNoticed = 1.1;
    if ((hid_ == nullptr && serial_ == nullptr) || !loop_ || !settings_.render.caps_from_latency) {
        return;
    }
    const double measured_s =
        hid_ != nullptr ? hid_->latency_s() : serial_->latency_s(settings_.rate_hz);
    if (measured_s <= kNoticed * settings_.render.latency_s) {
        return;
    }
    std::array<char, 200> text{};
    std::snprintf(
        text.data(), text.size(),
        "the measured latency of the link is %.2f ms, but link_latency of the SpidarGConfig is "
        "%.2f ms. Stiffness is clamped to what the measured latency allows.",
        1e3 * measured_s, 1e3 * settings_.render.latency_s);
    UtilityFunctions::push_warning(named(text.data()));
    settings_.render.latency_s = measured_s;
    want_limits(spidar::limits_by_latency(settings_));
}

void SpidarG::move_limits(double dt_s) {
    constexpr double kTime_s = 0.3;
    if (limits_share_ >= 1.0) {
        return;
    }
    limits_share_ = std::min(1.0, limits_share_ + dt_s / kTime_s);
    command_.limits = spidar::between(limits_from_, limits_wanted_, limits_share_);
    ++command_.limits_sequence;
    loop_->publish(command_);
}

std::string SpidarG::read_resources() {
    const SpidarGConfig &config = config_or_default();
    std::string problem = config.own_problem();
    spidar::ServoSettings settings = config.servo_settings();
    spidar::PlantSettings plant = config.plant_settings();
    settings.safety.max_force_n = std::min(settings.safety.max_force_n, options_.largest_force_n);
    if (problem.empty() && calibration_.is_valid()) {
        problem = calibration_->apply_to(settings);
    }
    if (problem.empty()) {
        problem = spidar::validate(settings);
    }
    if (problem.empty()) {
        problem = spidar::validate(plant);
    }
    if (problem.empty()) {
        settings_ = settings;
        plant_ = plant;
    }
    return problem;
}

godot::PackedStringArray SpidarG::_get_configuration_warnings() const {
    godot::PackedStringArray warnings;
    if (!problem_.empty()) {
        warnings.push_back(spidar::to_godot(problem_));
    }
    if (config_.is_null() && default_config_->get_path().is_empty()) {
        warnings.push_back(String(
            "No config: the paper's device (48 cm frame, 4 cm half poles) is assumed. Add a "
            "SpidarGConfig to describe your device, or name one for the whole project in the "
            "project setting spidar_g/device/default_config."));
    }
    if (config_or_default().get_max_force() > options_.largest_force_n) {
        warnings.push_back(spidar::to_godot(
            "SpidarGConfig.max_force = " + std::to_string(config_or_default().get_max_force()) +
            " N is clamped to " + std::to_string(options_.largest_force_n) +
            " N by the project setting spidar_g/safety/max_force: lower max_force or raise the "
            "project setting."));
    }
    const std::string odd = transform_problem();
    if (!odd.empty()) {
        warnings.push_back(spidar::to_godot(odd));
    }
    return warnings;
}

std::string SpidarG::transform_problem() const {
    const godot::Basis basis = (is_inside_tree() ? get_global_transform() : get_transform()).basis;
    if (basis.determinant() < 0.0) {
        return "The node or one of its parents is mirrored (negative scale), but a device cannot "
               "be mirrored: its grip then moves and turns differently from what the scene shows. "
               "Set every scale to positive values.";
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double length = static_cast<double>(basis.get_column(axis).length());
        if (!(std::abs(length - 1.0) <= kNodeScaleTolerance)) {
            return "The node or one of its parents is scaled, but a device cannot be scaled. Set "
                   "every scale to 1 and use workspace_scale to enlarge the device's movements.";
        }
    }
    return {};
}
