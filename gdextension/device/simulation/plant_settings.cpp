// Valid ranges of a plant's settings: they keep the integration stable and the counts within 32
// bits.
#include "core/base/describe_value.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

std::string validate(const PlantSettings &settings) {
    for (const std::string &problem :
         {validate(settings.frame), validate(settings.grip, settings.frame),
          validate(settings.motors)}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    constexpr double kRightAngle_rad = 1.5707963267948966;
    const ValueRange ranges[] = {
        {"metres_per_count", settings.metres_per_count, "m", 1e-9, 1e-2},
        {"string_stiffness_ea_n", settings.string_stiffness_ea_n, "N", 10.0, 3e4},
        {"string_damping_n_s_m", settings.string_damping_n_s_m, "N s/m", 0.0, 10.0},
        {"creep", settings.creep, "(strain at 10 N)", 0.0, 0.05},
        {"creep_time_s", settings.creep_time_s, "s", 0.1, 1e4},
        {"winding_growth", settings.winding_growth, "(share of the radius)", 0.0, 0.2},
        {"rotor_mass_kg", settings.rotor_mass_kg, "kg", 0.005, 10.0},
        {"coulomb_friction_n", settings.coulomb_friction_n, "N", 0.0, 10.0},
        {"viscous_friction_n_s_m", settings.viscous_friction_n_s_m, "N s/m", 0.0, 10.0},
        {"current_lag_s", settings.current_lag_s, "s", 0.0, 1.0},
        {"grip_mass_kg", settings.grip_mass_kg, "kg", 0.0, 10.0},
        {"grip_inertia_kg_m2", settings.grip_inertia_kg_m2, "kg m^2", 0.0, 1.0},
        {"grasp_inertia_kg_m2", settings.grasp_inertia_kg_m2, "kg m^2", 0.0, 1.0},
        {"output_latency_s", settings.output_latency_s, "s", 0.0, 0.02},
        {"output_jitter_s", settings.output_jitter_s, "s", 0.0, 0.005},
        {"report_loss", settings.report_loss, "(share)", 0.0, 0.5},
        {"hinge_open_rad", settings.hinge_open_rad, "rad", -kRightAngle_rad, 0.0},
        {"hinge_closed_rad", settings.hinge_closed_rad, "rad", 0.0, kRightAngle_rad},
    };
    std::string problem = first_out_of_range(ranges);
    for (std::size_t i = 0; i < kStringCount && problem.empty(); ++i) {
        const std::string offset = "length_offset_error_m[" + std::to_string(i) + "]";
        const std::string gain = "length_gain_error[" + std::to_string(i) + "]";
        const ValueRange of_string[] = {
            {offset.c_str(), settings.length_offset_error_m[i], "m", -1.0, 1.0},
            {gain.c_str(), settings.length_gain_error[i], "(relative)", -0.5, 0.5},
        };
        problem = first_out_of_range(of_string);
    }
    if (!problem.empty()) {
        return problem;
    }
    switch (settings.firmness) {
    case HandFirmness::light:
    case HandFirmness::normal:
    case HandFirmness::firm:
        return {};
    }
    return range_sentence("firmness", static_cast<double>(settings.firmness), "",
                          "set it to light, normal or firm.");
}

} // namespace spidar
