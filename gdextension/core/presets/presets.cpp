#include "core/presets/presets.h"

#include "core/calibration/string_calibration.h"
#include "core/tension/tension_solver.h"

namespace spidar {

namespace {

// HISpidar.cpp of Springhead (see THIRDPARTY.md): positions, length of a count, tension range.
constexpr StringVectors kX3rMotors_m{Vec3(-0.08485, -0.076, 0), Vec3(0, -0.076, 0.08485),
                                     Vec3(0.08485, -0.076, 0),  Vec3(0, -0.076, -0.08485),
                                     Vec3(-0.08485, 0.076, 0),  Vec3(0, 0.076, 0.08485),
                                     Vec3(0.08485, 0.076, 0),   Vec3(0, 0.076, -0.08485)};
constexpr StringVectors kX3rJoints_m{Vec3(-0.01591, 0, -0.01591), Vec3(0.01591, 0, 0.01591),
                                     Vec3(0, -0.0225, 0),         Vec3(0, -0.0225, 0),
                                     Vec3(-0.01591, 0, -0.01591), Vec3(0.01591, 0, 0.01591),
                                     Vec3(0, 0.0225, 0),          Vec3(0, 0.0225, 0)};
constexpr StringVectors kX3lMotors_m{Vec3(0.08485, 0.076, 0),   Vec3(0, 0.076, 0.08485),
                                     Vec3(-0.08485, 0.076, 0),  Vec3(0, 0.076, -0.08485),
                                     Vec3(0.08485, -0.076, 0),  Vec3(0, -0.076, 0.08485),
                                     Vec3(-0.08485, -0.076, 0), Vec3(0, -0.076, -0.08485)};
constexpr StringVectors kX3lJoints_m{Vec3(0.01591, 0, -0.01591), Vec3(-0.01591, 0, 0.01591),
                                     Vec3(0, 0.0225, 0),         Vec3(0, 0.0225, 0),
                                     Vec3(0.01591, 0, -0.01591), Vec3(-0.01591, 0, 0.01591),
                                     Vec3(0, -0.0225, 0),        Vec3(0, -0.0225, 0)};
constexpr double kX3MetresPerCount = 1.66555e-5;
constexpr double kX3MinTension_n = 0.3;
constexpr double kX3MaxTension_n = 20.0;

DevicePreset x3(const char *name, const StringVectors &motors_m,
                const StringVectors &joints_m) noexcept {
    DevicePreset preset;
    preset.name = name;
    preset.frame.motors_m = motors_m;
    preset.grip = make_rigid_grip(joints_m);
    preset.metres_per_count = kX3MetresPerCount;
    preset.min_tension_n = kX3MinTension_n;
    preset.max_tension_n = kX3MaxTension_n;
    return preset;
}

DevicePreset paper() noexcept {
    DevicePreset preset;
    preset.name = "Paper";
    preset.frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    preset.metres_per_count = kPaperMetresPerCount;
    preset.min_tension_n = TensionSettings{}.min_tension_n;
    preset.max_tension_n = TensionSettings{}.max_tension_n;
    return preset;
}

} // namespace

DevicePreset device_preset(Preset preset) noexcept {
    switch (preset) {
    case Preset::spidar_g6_x3r:
        return x3("SpidarG6X3R", kX3rMotors_m, kX3rJoints_m);
    case Preset::spidar_g6_x3l:
        return x3("SpidarG6X3L", kX3lMotors_m, kX3lJoints_m);
    case Preset::paper:
        break;
    }
    return paper();
}

} // namespace spidar
