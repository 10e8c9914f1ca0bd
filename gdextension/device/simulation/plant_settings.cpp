// What a plant can be made of: the ranges that keep its integration stable and its counts in 32 bits.
#include <cmath>
#include <cstdio>

#include "device/simulation/simulated_plant.h"

namespace spidar {

namespace {

std::string out_of_range(const char *field, double value, double low, double high,
                         const char *unit) {
    char text[256];
    std::snprintf(text, sizeof(text), "%s is %g %s: set it between %g and %g %s.", field, value,
                  unit, low, high, unit);
    return text;
}

struct Range {
    const char *field;
    double value;
    double low;
    double high;
    const char *unit;
};

} // namespace

std::string validate(const PlantSettings &settings) {
    for (const std::string &problem :
         {validate(settings.frame), validate(settings.grip, settings.frame),
          validate(settings.motors)}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    constexpr double kRightAngle_rad = 1.5707963267948966;
    const Range ranges[] = {
        {"metres_per_count", settings.metres_per_count, 1e-9, 1e-2, "m"},
        {"string_stiffness_ea_n", settings.string_stiffness_ea_n, 10.0, 3e4, "N"},
        {"string_damping_n_s_m", settings.string_damping_n_s_m, 0.0, 10.0, "N s/m"},
        {"creep", settings.creep, 0.0, 0.05, "(strain at 10 N)"},
        {"creep_time_s", settings.creep_time_s, 0.1, 1e4, "s"},
        {"winding_growth", settings.winding_growth, 0.0, 0.2, "(share of the radius)"},
        {"rotor_mass_kg", settings.rotor_mass_kg, 0.005, 10.0, "kg"},
        {"coulomb_friction_n", settings.coulomb_friction_n, 0.0, 10.0, "N"},
        {"viscous_friction_n_s_m", settings.viscous_friction_n_s_m, 0.0, 10.0, "N s/m"},
        {"current_lag_s", settings.current_lag_s, 0.0, 1.0, "s"},
        {"grip_mass_kg", settings.grip_mass_kg, 0.0, 10.0, "kg"},
        {"grip_inertia_kg_m2", settings.grip_inertia_kg_m2, 0.0, 1.0, "kg m^2"},
        {"grasp_inertia_kg_m2", settings.grasp_inertia_kg_m2, 0.0, 1.0, "kg m^2"},
        {"output_latency_s", settings.output_latency_s, 0.0, 0.02, "s"},
        {"output_jitter_s", settings.output_jitter_s, 0.0, 0.005, "s"},
        {"report_loss", settings.report_loss, 0.0, 0.5, "(share)"},
        {"hinge_open_rad", settings.hinge_open_rad, -kRightAngle_rad, 0.0, "rad"},
        {"hinge_closed_rad", settings.hinge_closed_rad, 0.0, kRightAngle_rad, "rad"},
    };
    for (const Range &range : ranges) {
        if (!(range.value >= range.low && range.value <= range.high)) { // NaN fails too
            return out_of_range(range.field, range.value, range.low, range.high, range.unit);
        }
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        char field[64];
        if (!(std::abs(settings.length_offset_error_m[i]) <= 1.0)) {
            std::snprintf(field, sizeof(field), "length_offset_error_m[%zu]", i);
            return out_of_range(field, settings.length_offset_error_m[i], -1.0, 1.0, "m");
        }
        if (!(std::abs(settings.length_gain_error[i]) <= 0.5)) {
            std::snprintf(field, sizeof(field), "length_gain_error[%zu]", i);
            return out_of_range(field, settings.length_gain_error[i], -0.5, 0.5, "(relative)");
        }
    }
    switch (settings.firmness) {
    case HandFirmness::light:
    case HandFirmness::normal:
    case HandFirmness::firm:
        return {};
    }
    return out_of_range("firmness", static_cast<double>(settings.firmness), 0.0, 2.0,
                        "(light, normal, firm)");
}

} // namespace spidar
