#include "core/presets/presets.h"

#include "core/calibration/string_calibration.h"
#include "core/tension/tension_solver.h"

namespace spidar {

namespace {

// Positions, length of a count and tension range: HISpidar.cpp of Springhead (THIRDPARTY.md).
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

// The joints of the X5 and X4 grips lie on the axes of the frame.
constexpr StringVectors kX5rMotors_m{
    Vec3(-0.0775, -0.0735, 0.0775),  Vec3(0.0775, -0.0735, 0.0775), Vec3(0.0775, -0.0735, -0.0775),
    Vec3(-0.0775, -0.0735, -0.0775), Vec3(-0.0775, 0.0735, 0.0775), Vec3(0.0775, 0.0735, 0.0775),
    Vec3(0.0775, 0.0735, -0.0775),   Vec3(-0.0775, 0.0735, -0.0775)};
constexpr StringVectors kX5rJoints_m{Vec3(-0.015, 0, 0), Vec3(0.015, 0, 0),  Vec3(0, -0.015, 0),
                                     Vec3(0, -0.015, 0), Vec3(-0.015, 0, 0), Vec3(0.015, 0, 0),
                                     Vec3(0, 0.015, 0),  Vec3(0, 0.015, 0)};
constexpr StringVectors kX5lMotors_m{
    Vec3(0.0775, 0.0735, -0.0775),  Vec3(0.0775, 0.0735, 0.0775),   Vec3(-0.0775, 0.0735, 0.0775),
    Vec3(-0.0775, 0.0735, -0.0775), Vec3(0.0775, -0.0735, -0.0775), Vec3(0.0775, -0.0735, 0.0775),
    Vec3(-0.0775, -0.0735, 0.0775), Vec3(-0.0775, -0.0735, -0.0775)};
constexpr StringVectors kX5lJoints_m{Vec3(0, 0, -0.015), Vec3(0, 0, 0.015),  Vec3(0, 0.015, 0),
                                     Vec3(0, 0.015, 0),  Vec3(0, 0, -0.015), Vec3(0, 0, 0.015),
                                     Vec3(0, -0.015, 0), Vec3(0, -0.015, 0)};
constexpr StringVectors kX4Motors_m{Vec3(0.069, -0.095, -0.069), Vec3(0.069, -0.095, 0.069),
                                    Vec3(-0.069, -0.095, 0.069), Vec3(-0.069, -0.095, -0.069),
                                    Vec3(0.069, 0.095, -0.069),  Vec3(0.069, 0.095, 0.069),
                                    Vec3(-0.069, 0.095, 0.069),  Vec3(-0.069, 0.095, -0.069)};
constexpr StringVectors kX4Joints_m{Vec3(0, -0.0225, 0), Vec3(0.0225, 0, 0), Vec3(-0.0225, 0, 0),
                                    Vec3(0, -0.0225, 0), Vec3(0, 0.0225, 0), Vec3(0.0225, 0, 0),
                                    Vec3(-0.0225, 0, 0), Vec3(0, 0.0225, 0)};
// Command units of a board (12 bits for 3.3 V) per volt that the usual host sends.
constexpr double kUnitsPerVolt = 4096.0 / 3.3;
constexpr BoardWiring kX5rBoards{
    0.091 * kUnitsPerVolt, {-1, 1, -1, 1, -1, 1, -1, 1}, {1, -1, 1, -1, 1, -1, 1, -1}};
constexpr BoardWiring kX5lBoards{0.091 * kUnitsPerVolt};
constexpr BoardWiring kX4Boards{
    0.08 * kUnitsPerVolt, {-1, -1, 1, 1, 1, 1, -1, -1}, {1, 1, -1, -1, -1, -1, 1, 1}};

// Length of one encoder count (unit: m), and the tension range of the device's own driver (N).
struct Drive {
    double metres_per_count;
    double min_tension_n;
    double max_tension_n;
};
constexpr Drive kX3Drive{1.66555e-5, 0.3, 20.0};
constexpr Drive kX4Drive{3.485e-5, 0.2, 20.0};
constexpr Drive kX5Drive{2.25e-5, 0.3, 6.0};

DevicePreset rigid(const char *name, const StringVectors &motors_m, const StringVectors &joints_m,
                   const Drive &drive, const BoardWiring &boards = {}) noexcept {
    DevicePreset preset;
    preset.name = name;
    preset.frame.motors_m = motors_m;
    preset.grip = make_rigid_grip(joints_m);
    preset.metres_per_count = drive.metres_per_count;
    preset.min_tension_n = drive.min_tension_n;
    preset.max_tension_n = drive.max_tension_n;
    preset.boards = boards;
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
        return rigid("SpidarG6X3R", kX3rMotors_m, kX3rJoints_m, kX3Drive);
    case Preset::spidar_g6_x3l:
        return rigid("SpidarG6X3L", kX3lMotors_m, kX3lJoints_m, kX3Drive);
    case Preset::spidar_g6_x5r:
        return rigid("SpidarG6X5R", kX5rMotors_m, kX5rJoints_m, kX5Drive, kX5rBoards);
    case Preset::spidar_g6_x5l:
        return rigid("SpidarG6X5L", kX5lMotors_m, kX5lJoints_m, kX5Drive, kX5lBoards);
    case Preset::spidar_g6_x4:
        return rigid("SpidarG6X4", kX4Motors_m, kX4Joints_m, kX4Drive, kX4Boards);
    case Preset::paper:
        break;
    }
    return paper();
}

} // namespace spidar
