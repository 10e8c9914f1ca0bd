#include <doctest/doctest.h>

#include <limits>
#include <string>

#include "core/presets/presets.h"
#include "support/servo_fixture.h"

using namespace spidar;

namespace {

bool names(const ServoSettings &settings, const char *field) {
    return validate(settings).find(field) != std::string::npos;
}

} // namespace

TEST_CASE("settings: the ideal device is fine, an uncalibrated one is not") {
    CHECK(validate(spidar::test::ideal_settings()).empty());
    CHECK_FALSE(validate(ServoSettings()).empty()); // strings must be given
}

TEST_CASE("settings: every number out of range is named with its value") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    struct Field {
        const char *name;
        double ServoSettings::*own;
        double SafetySettings::*safety;
    };
    const Field fields[] = {
        {"rate_hz", &ServoSettings::rate_hz, nullptr},
        {"velocity_cutoff_hz", &ServoSettings::velocity_cutoff_hz, nullptr},
        {"arming_time_s", nullptr, &SafetySettings::arming_time_s},
        {"tension_slew_n_per_ms", nullptr, &SafetySettings::tension_slew_n_per_ms},
        {"max_force_n", nullptr, &SafetySettings::max_force_n},
        {"max_moment_nm", nullptr, &SafetySettings::max_moment_nm},
        {"max_grasp_torque_nm", nullptr, &SafetySettings::max_grasp_torque_nm},
        {"max_count_speed_m_s", nullptr, &SafetySettings::max_count_speed_m_s},
        {"read_timeout_fade_s", nullptr, &SafetySettings::read_timeout_fade_s},
        {"read_timeout_fault_s", nullptr, &SafetySettings::read_timeout_fault_s},
        {"max_grip_speed_m_s", nullptr, &SafetySettings::max_grip_speed_m_s},
        {"wrench_fade_s", nullptr, &SafetySettings::wrench_fade_s},
        {"contacts_full_s", nullptr, &SafetySettings::contacts_full_s},
        {"contacts_gone_s", nullptr, &SafetySettings::contacts_gone_s},
    };
    for (const Field &field : fields) {
        for (const double bad : {kNan, -1.0, 1e9}) {
            ServoSettings settings = spidar::test::ideal_settings();
            (field.own != nullptr ? settings.*field.own : settings.safety.*field.safety) = bad;
            CAPTURE(field.name);
            CAPTURE(bad);
            CHECK(names(settings, field.name));
        }
    }
    ServoSettings settings = spidar::test::ideal_settings();
    settings.safety.max_bad_samples = 0;
    CHECK(names(settings, "max_bad_samples"));
}

TEST_CASE("settings: numbers that contradict each other") {
    ServoSettings settings = spidar::test::ideal_settings();
    settings.safety.read_timeout_fault_s = 0.004; // before the fade
    CHECK(names(settings, "read_timeout_fault_s"));
    settings = spidar::test::ideal_settings();
    settings.safety.contacts_gone_s = settings.safety.contacts_full_s;
    CHECK(names(settings, "contacts_gone_s"));
    settings = spidar::test::ideal_settings();
    settings.motors.max_current_a.fill(0.05); // 0.27 N: less than the pretension
    CHECK(names(settings, "max_current_a"));
    settings = spidar::test::ideal_settings();
    settings.tension.dof_mask = 0x40; // the grasp alone
    CHECK(validate(settings).empty());
    const DevicePreset rigid = device_preset(Preset::spidar_g6_x3r);
    settings.frame = rigid.frame;
    settings.grip = rigid.grip;
    CHECK(names(settings, "dof_mask"));
}

TEST_CASE("settings: the parts are checked too") {
    ServoSettings settings = spidar::test::ideal_settings();
    settings.grip.pole_half_length_m = -1.0;
    CHECK(names(settings, "pole_half_length_m"));
    settings = spidar::test::ideal_settings();
    settings.tension.max_tension_n = -1.0;
    CHECK(names(settings, "tension"));
    settings = spidar::test::ideal_settings();
    settings.grasp.dwell_s = -1.0;
    CHECK(names(settings, "dwell_s"));
}
