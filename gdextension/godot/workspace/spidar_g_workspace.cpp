#include "godot/workspace/spidar_g_workspace.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/variant/utility_functions.hpp>

#include "core/analysis/wrench_closure.h"
#include "core/base/finite.h"
#include "core/geometry/grip_geometry.h"
#include "device/contract/dof_lanes.h"
#include "device/safety/monitors/workspace_guard.h"
#include "device/step/tension_diagnosis.h"
#include "godot/base/type_conversions.h"
#include "godot/settings/project_options.h"

using godot::PackedFloat64Array;
using godot::PackedVector3Array;
using godot::Transform3D;
using spidar::PaperWrench;
using spidar::Vec3;

namespace {

// Largest deviation of a rotation's axes from unit length and right angles that counts as rounding.
constexpr double kRotationTolerance = 1e-4;
// Shortest vector that counts as a direction.
constexpr double kLeastDirection = 1e-9;

bool is_rotation(const spidar::Mat3 &m) {
    const spidar::Mat3 rest = glm::transpose(m) * m - spidar::Mat3(1.0);
    if (!spidar::all_finite(rest)) {
        return false;
    }
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            largest = std::max(largest, std::abs(rest[column][row]));
        }
    }
    return largest <= kRotationTolerance && glm::determinant(m) > 0.0;
}

void complain(const char *method, const std::string &message) {
    godot::UtilityFunctions::push_error(
        spidar::to_godot(std::string("SpidarGWorkspace.") + method + ": " + message));
}

// Returns the largest factor of `wrench` that the strings give exactly; 0 when there is none.
double largest_factor(const spidar::WrenchMatrix &matrix, const PaperWrench &wrench,
                      const spidar::TensionSettings &settings) {
    const spidar::FeasibleScale scale = spidar::feasible_scale(matrix, wrench, settings);
    return scale.any ? scale.largest : 0.0;
}

PaperWrench paper_wrench(const godot::Vector3 &force, const godot::Vector3 &moment,
                         double grasp_torque) {
    return spidar::to_paper({spidar::to_core(force), spidar::to_core(moment), grasp_torque});
}

bool is_finite(const char *method, const PaperWrench &wrench) {
    const bool good = spidar::all_finite(wrench);
    if (!good) {
        complain(
            method,
            "force (N), moment (N m) or grasp_torque (N m) is not finite: give finite numbers.");
    }
    return good;
}

} // namespace

SpidarGWorkspace::SpidarGWorkspace() {
    default_config_ = spidar::project_config();
    if (default_config_.is_null()) {
        default_config_.instantiate();
    }
}

void SpidarGWorkspace::set_config(const godot::Ref<SpidarGConfig> &config) {
    config_ = config;
}

const SpidarGConfig &SpidarGWorkspace::config_or_default() const {
    return config_.is_valid() ? *config_.ptr() : *default_config_.ptr();
}

godot::String SpidarGWorkspace::get_problem() const {
    return config_or_default().get_problem();
}

PackedVector3Array SpidarGWorkspace::get_motor_positions() const {
    PackedVector3Array positions;
    for (const Vec3 &motor : config_or_default().servo_settings().frame.motors_m) {
        positions.push_back(spidar::to_godot(motor));
    }
    return positions;
}

PackedVector3Array SpidarGWorkspace::get_attachment_points(const Transform3D &pose,
                                                           double grasp_angle) const {
    PackedVector3Array points;
    const std::optional<Place> here = place("get_attachment_points", pose, grasp_angle);
    for (int string = 0; here && string < spidar::kStringCount; ++string) {
        points.push_back(
            spidar::to_godot(spidar::attachment_point(here->grip, here->pose, string)));
    }
    return points;
}

PackedVector3Array SpidarGWorkspace::get_box() const {
    spidar::WorkspaceGuard guard;
    guard.configure(config_or_default().servo_settings());
    PackedVector3Array corners;
    corners.push_back(spidar::to_godot(guard.free_box().low_m));
    corners.push_back(spidar::to_godot(guard.free_box().high_m));
    return corners;
}

std::optional<SpidarGWorkspace::Place>
SpidarGWorkspace::place(const char *method, const Transform3D &pose, double grasp_angle) const {
    const SpidarGConfig &config = config_or_default();
    const spidar::ServoSettings settings = config.servo_settings();
    std::string problem = config.own_problem();
    if (problem.empty()) {
        problem = spidar::validate(settings);
    }
    if (!problem.empty()) {
        complain(method, problem);
        return std::nullopt;
    }
    const Vec3 position = spidar::to_core(pose.origin);
    const spidar::Mat3 turn = spidar::to_core(pose.basis);
    if (!spidar::all_finite(position) || !is_rotation(turn)) {
        complain(method,
                 "the pose of the grip (m) is not finite or its basis is not a pure rotation: "
                 "give finite numbers and use Basis.orthonormalized().");
        return std::nullopt;
    }
    if (!(std::abs(grasp_angle) <= 90.0 * spidar::kDegree_rad)) {
        complain(method,
                 "grasp_angle = " + std::to_string(grasp_angle) + " rad: give -pi/2 to pi/2.");
        return std::nullopt;
    }
    Place here;
    here.grip = settings.grip;
    here.pose = spidar::make_pose(settings.grip, position, turn, grasp_angle);
    here.matrix = spidar::wrench_matrix(settings.frame, settings.grip, here.pose);
    here.tension = spidar::solver_settings(settings);
    return here;
}

double SpidarGWorkspace::get_closure_margin(const Transform3D &pose, double grasp_angle) const {
    const std::optional<Place> here = place("get_closure_margin", pose, grasp_angle);
    return here ? spidar::wrench_closure(here->matrix, here->tension).margin : 0.0;
}

PackedFloat64Array SpidarGWorkspace::get_closure_margins(const PackedVector3Array &positions,
                                                         const godot::Basis &turn,
                                                         double grasp_angle) const {
    PackedFloat64Array margins;
    const Transform3D middle(turn, godot::Vector3());
    const std::optional<Place> first = place("get_closure_margins", middle, grasp_angle);
    if (!first) {
        return margins;
    }
    margins.resize(positions.size());
    const spidar::FrameGeometry frame = config_or_default().servo_settings().frame;
    spidar::GripPose pose = first->pose;
    for (std::int64_t i = 0; i < positions.size(); ++i) {
        pose.position_m = spidar::to_core(positions[i]);
        if (!spidar::all_finite(pose.position_m)) {
            complain("get_closure_margins",
                     "position " + std::to_string(i) + " (m) is not finite: give finite numbers.");
            return {};
        }
        margins[i] =
            spidar::wrench_closure(spidar::wrench_matrix(frame, first->grip, pose), first->tension)
                .margin;
    }
    return margins;
}

PackedFloat64Array SpidarGWorkspace::capacity(const char *method, std::size_t first,
                                              const Transform3D &pose, double grasp_angle,
                                              const PackedVector3Array &along) const {
    PackedFloat64Array largest;
    const std::optional<Place> here = place(method, pose, grasp_angle);
    if (!here) {
        return largest;
    }
    largest.resize(along.size());
    for (std::int64_t i = 0; i < along.size(); ++i) {
        const Vec3 direction = spidar::to_core(along[i]);
        const double length = glm::length(direction);
        if (!(length > kLeastDirection) || !spidar::all_finite(direction)) {
            complain(method, "direction " + std::to_string(i) +
                                 " is zero or not finite: give a finite vector of any length "
                                 "above 0.");
            return {};
        }
        PaperWrench wrench{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            wrench[first + axis] = direction[static_cast<int>(axis)] / length;
        }
        largest[i] = largest_factor(here->matrix, wrench, here->tension);
    }
    return largest;
}

PackedFloat64Array
SpidarGWorkspace::get_force_capacity(const Transform3D &pose, double grasp_angle,
                                     const PackedVector3Array &directions) const {
    return capacity("get_force_capacity", 0, pose, grasp_angle, directions);
}

PackedFloat64Array SpidarGWorkspace::get_moment_capacity(const Transform3D &pose,
                                                         double grasp_angle,
                                                         const PackedVector3Array &axes) const {
    return capacity("get_moment_capacity", 3, pose, grasp_angle, axes);
}

godot::Vector2 SpidarGWorkspace::get_grasp_capacity(const Transform3D &pose,
                                                    double grasp_angle) const {
    const std::optional<Place> here = place("get_grasp_capacity", pose, grasp_angle);
    if (!here || here->grip.kind == spidar::GripKind::rigid) {
        return {};
    }
    const auto most = [&here](double torque_nm) {
        const PaperWrench wrench = spidar::to_paper({Vec3(0.0), Vec3(0.0), torque_nm});
        return static_cast<spidar::GodotReal>(largest_factor(here->matrix, wrench, here->tension));
    };
    return {most(1.0), most(-1.0)};
}

PackedFloat64Array SpidarGWorkspace::get_tensions(const Transform3D &pose, double grasp_angle,
                                                  const godot::Vector3 &force,
                                                  const godot::Vector3 &moment,
                                                  double grasp_torque) const {
    const std::optional<Place> here = place("get_tensions", pose, grasp_angle);
    const PaperWrench wrench = paper_wrench(force, moment, grasp_torque);
    if (!here || !is_finite("get_tensions", wrench)) {
        return {};
    }
    spidar::TensionSolver solver;
    solver.configure(here->tension);
    return spidar::to_godot(solver.update(here->matrix, wrench).tensions_n);
}

PackedFloat64Array SpidarGWorkspace::get_given_wrench(const Transform3D &pose, double grasp_angle,
                                                      const godot::Vector3 &force,
                                                      const godot::Vector3 &moment,
                                                      double grasp_torque) const {
    const std::optional<Place> here = place("get_given_wrench", pose, grasp_angle);
    const PaperWrench wrench = paper_wrench(force, moment, grasp_torque);
    if (!here || !is_finite("get_given_wrench", wrench)) {
        return {};
    }
    spidar::TensionSolver solver;
    solver.configure(here->tension);
    const spidar::Wrench given = spidar::from_paper(
        spidar::apply(here->matrix, solver.update(here->matrix, wrench).tensions_n));
    return spidar::to_godot(spidar::lanes(given));
}

void SpidarGWorkspace::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGWorkspace." + message));
}

void SpidarGWorkspace::_bind_methods() {
    using godot::ClassDB;
    using godot::D_METHOD;
    using Self = SpidarGWorkspace;
    spidar::bind_checked<&Self::set_config, "", "set_config", "config">();
    ClassDB::bind_method(D_METHOD("get_config"), &Self::get_config);
    ADD_PROPERTY(godot::PropertyInfo(godot::Variant::OBJECT, "config",
                                     godot::PROPERTY_HINT_RESOURCE_TYPE, "SpidarGConfig"),
                 "set_config", "get_config");
    ClassDB::bind_method(D_METHOD("get_problem"), &Self::get_problem);
    ClassDB::bind_method(D_METHOD("get_motor_positions"), &Self::get_motor_positions);
    spidar::bind_checked<&Self::get_attachment_points, "", "get_attachment_points", "pose",
                         "grasp_angle">();
    ClassDB::bind_method(D_METHOD("get_box"), &Self::get_box);
    spidar::bind_checked<&Self::get_closure_margin, "", "get_closure_margin", "pose",
                         "grasp_angle">();
    spidar::bind_checked<&Self::get_closure_margins, "", "get_closure_margins", "positions", "turn",
                         "grasp_angle">();
    spidar::bind_checked<&Self::get_force_capacity, "", "get_force_capacity", "pose", "grasp_angle",
                         "directions">();
    spidar::bind_checked<&Self::get_moment_capacity, "", "get_moment_capacity", "pose",
                         "grasp_angle", "axes">();
    spidar::bind_checked<&Self::get_grasp_capacity, "", "get_grasp_capacity", "pose",
                         "grasp_angle">();
    spidar::bind_checked<&Self::get_tensions, "", "get_tensions", "pose", "grasp_angle", "force",
                         "moment", "grasp_torque">();
    spidar::bind_checked<&Self::get_given_wrench, "", "get_given_wrench", "pose", "grasp_angle",
                         "force", "moment", "grasp_torque">();
}
