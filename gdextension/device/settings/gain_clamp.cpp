#include "device/settings/gain_clamp.h"

#include <cstdio>
#include <iterator>

namespace spidar {

namespace {

struct GainName {
    const char *name;
    const char *unit;
    const char *setting; // the setting that raises the cap
};

// In the order of GainClamp::Gain.
constexpr GainName kGains[] = {
    {"", "", ""},
    {"stiffness", "N/m", "max_stiffness"},
    {"damping", "N s/m", "max_damping"},
    {"turning stiffness", "N m/rad", "max_turn_stiffness"},
    {"turning damping", "N m s/rad", "max_turn_damping"},
    {"grasp stiffness", "N m/rad", "max_grasp_stiffness"},
    {"grasp damping", "N m s/rad", "max_grasp_damping"},
    {"friction", "", ""},
    {"velocity", "m/s or rad/s", ""},
    {"strength", "N or N m", ""},
    {"wrench", "times the request", "max_force, max_moment, max_grasp_torque"},
};
static_assert(std::size(kGains) == static_cast<std::size_t>(GainClamp::Gain::wrench) + 1);

// In the order of GainClamp::Request.
constexpr const char *kRequests[] = {"contact", "coupling, DOF", "effect", "request"};
static_assert(std::size(kRequests) == static_cast<std::size_t>(GainClamp::Request::wrench) + 1);

} // namespace

std::string describe(const GainClamp &clamp, const RenderSettings &settings, double rate_hz) {
    if (!clamp) {
        return {};
    }
    const GainName &gain = kGains[static_cast<std::size_t>(clamp.gain)];
    char text[320];
    const int written = std::snprintf(text, sizeof text, "%s %d: %s was clamped from %g to %g %s: ",
                                      kRequests[static_cast<std::size_t>(clamp.request)],
                                      static_cast<int>(clamp.index), gain.name, clamp.asked,
                                      clamp.given, gain.unit);
    std::string sentence(text, static_cast<std::size_t>(written));
    if (clamp.from_latency) {
        std::snprintf(
            text, sizeof text,
            "the limit that keeps every simulated hand stable at a latency of %g ms and a rate of "
            "%g Hz. Request less, or lower the device's latency.",
            1e3 * settings.latency_s, rate_hz);
    } else if (gain.setting[0] != '\0') {
        std::snprintf(text, sizeof text, "the limit of the settings. Request less, or raise %s.",
                      gain.setting);
    } else {
        std::snprintf(text, sizeof text, "the fixed limit of the add-on. Request less.");
    }
    return sentence + text;
}

} // namespace spidar
