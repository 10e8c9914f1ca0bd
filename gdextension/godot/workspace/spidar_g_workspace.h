// SpidarGWorkspace: computes which wrenches the strings of a device can exert at any pose of the
// grip, without opening a device. Used by the editor's 3D view; games may use it too. All values
// are in the device frame: SI units, origin at the frame's center.
// The class reference is gdextension/doc_classes/SpidarGWorkspace.xml.
#pragma once

#include <optional>
#include <string>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/basis.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/vector2.hpp>

#include "core/tension/tension_solver.h"
#include "godot/settings/spidar_g_config.h"

class SpidarGWorkspace : public godot::RefCounted {
    GDCLASS(SpidarGWorkspace, godot::RefCounted)
    SPIDAR_G_CHECKED_CALLS

public:
    SpidarGWorkspace();

    // Reports a refused argument in the output.
    void refuse(const std::string &message) const;
    void set_config(const godot::Ref<SpidarGConfig> &config);
    [[nodiscard]] godot::Ref<SpidarGConfig> get_config() const { return config_; }
    [[nodiscard]] godot::String get_problem() const;

    // Positions (unit: m).
    [[nodiscard]] godot::PackedVector3Array get_motor_positions() const;
    [[nodiscard]] godot::PackedVector3Array get_attachment_points(const godot::Transform3D &pose,
                                                                  double grasp_angle) const;
    [[nodiscard]] godot::PackedVector3Array get_box() const;

    // Capabilities of the strings at a pose.
    [[nodiscard]] double get_closure_margin(const godot::Transform3D &pose,
                                            double grasp_angle) const;
    [[nodiscard]] godot::PackedFloat64Array
    get_closure_margins(const godot::PackedVector3Array &positions, const godot::Basis &turn,
                        double grasp_angle) const;
    [[nodiscard]] godot::PackedFloat64Array
    get_force_capacity(const godot::Transform3D &pose, double grasp_angle,
                       const godot::PackedVector3Array &directions) const;
    [[nodiscard]] godot::PackedFloat64Array
    get_moment_capacity(const godot::Transform3D &pose, double grasp_angle,
                        const godot::PackedVector3Array &axes) const;
    [[nodiscard]] godot::Vector2 get_grasp_capacity(const godot::Transform3D &pose,
                                                    double grasp_angle) const;
    [[nodiscard]] godot::PackedFloat64Array
    get_tensions(const godot::Transform3D &pose, double grasp_angle, const godot::Vector3 &force,
                 const godot::Vector3 &moment, double grasp_torque) const;
    [[nodiscard]] godot::PackedFloat64Array get_given_wrench(const godot::Transform3D &pose,
                                                             double grasp_angle,
                                                             const godot::Vector3 &force,
                                                             const godot::Vector3 &moment,
                                                             double grasp_torque) const;

protected:
    static void _bind_methods();

private:
    // A pose of the grip with its wrench matrix, and the settings of the servo loop's solver.
    struct Place {
        spidar::GripGeometry grip;
        spidar::GripPose pose;
        spidar::WrenchMatrix matrix;
        spidar::TensionSettings tension;
    };

    [[nodiscard]] const SpidarGConfig &config_or_default() const;
    // Returns the Place of a pose. Returns nothing and prints an error when the config or the pose
    // is unusable.
    [[nodiscard]] std::optional<Place> place(const char *method, const godot::Transform3D &pose,
                                             double grasp_angle) const;
    // Returns for each direction the largest force (first = 0, unit: N) or moment (first = 3,
    // unit: N m) that the strings can exert along it; 0 if none.
    [[nodiscard]] godot::PackedFloat64Array capacity(const char *method, std::size_t first,
                                                     const godot::Transform3D &pose,
                                                     double grasp_angle,
                                                     const godot::PackedVector3Array &along) const;

    godot::Ref<SpidarGConfig> config_;
    godot::Ref<SpidarGConfig> default_config_; // used when config_ is null
};
