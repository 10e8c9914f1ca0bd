#include "device/settings/gain_clamp.h"

#include <cstdio>

namespace spidar {

namespace {

struct GainName {
    const char *name;
    const char *unit;
    const char *setting; // that lifts the cap
};

GainName name_of(GainClamp::Gain gain) {
    using Gain = GainClamp::Gain;
    switch (gain) {
    case Gain::stiffness:
        return {"stiffness", "N/m", "max_stiffness"};
    case Gain::damping:
        return {"damping", "N s/m", "max_damping"};
    case Gain::turn_stiffness:
        return {"turning stiffness", "N m/rad", "max_turn_stiffness"};
    case Gain::turn_damping:
        return {"turning damping", "N m s/rad", "max_turn_damping"};
    case Gain::grasp_stiffness:
        return {"grasp stiffness", "N m/rad", "max_grasp_stiffness"};
    case Gain::grasp_damping:
        return {"grasp damping", "N m s/rad", "max_grasp_damping"};
    case Gain::friction:
        return {"friction", "", ""};
    case Gain::speed:
        return {"velocity", "m/s or rad/s", ""};
    case Gain::force:
        return {"strength", "N or N m", ""};
    case Gain::wrench:
        return {"wrench", "of what was asked", "max_force, max_moment, max_grasp_torque"};
    case Gain::none:
        break;
    }
    return {"", "", ""};
}

const char *name_of(GainClamp::Request request) {
    switch (request) {
    case GainClamp::Request::contact:
        return "contact";
    case GainClamp::Request::coupling:
        return "coupling, DOF";
    case GainClamp::Request::effect:
        return "effect";
    case GainClamp::Request::wrench:
        return "request";
    }
    return "request";
}

} // namespace

std::string describe(const GainClamp &clamp, const RenderSettings &settings, double rate_hz) {
    if (!clamp) {
        return {};
    }
    const GainName gain = name_of(clamp.gain);
    char text[320];
    const int written = std::snprintf(
        text, sizeof text, "%s %d: %s %g brought down to %g %s: ", name_of(clamp.request),
        static_cast<int>(clamp.index), gain.name, clamp.asked, clamp.given, gain.unit);
    std::string sentence(text, static_cast<std::size_t>(written));
    if (clamp.from_latency) {
        std::snprintf(
            text, sizeof text,
            "the most that %g ms of latency at %g Hz keep stable in every simulated hand. "
            "Ask for less, or lower the device's latency.",
            1e3 * settings.latency_s, rate_hz);
    } else if (gain.setting[0] != '\0') {
        std::snprintf(text, sizeof text, "the limit of the settings. Ask for less, or raise %s.",
                      gain.setting);
    } else {
        std::snprintf(text, sizeof text, "no hand can use more. Ask for less.");
    }
    return sentence + text;
}

} // namespace spidar
