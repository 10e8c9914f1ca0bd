// Shared by the tests of the simulated plant and transport.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "core/geometry/grip_geometry.h"
#include "device/contract/dof_lanes.h"
#include "device/simulation/simulated_plant.h"

namespace spidar::test {

// Rotation by |v| about v, by Rodrigues' formula.
inline Mat3 rotation_by(const Vec3 &v) {
    const double angle = glm::length(v);
    if (angle == 0.0) {
        return Mat3(1.0);
    }
    const Vec3 k = v / angle;
    const Mat3 cross(Vec3(0.0, k.z, -k.y), Vec3(-k.z, 0.0, k.x), Vec3(k.y, -k.x, 0.0));
    return Mat3(1.0) + std::sin(angle) * cross + (1.0 - std::cos(angle)) * (cross * cross);
}

// Reproducible on every machine: std distributions are not.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0);
    }
    Vec3 vector(double half) {
        return {between(-half, half), between(-half, half), between(-half, half)};
    }
    HandTarget pose(double reach_m, double turn_rad, double grasp_rad) {
        HandTarget target;
        target.position_m = vector(reach_m);
        target.rotation = rotation_by(vector(turn_rad));
        target.grasp_angle_rad = between(-grasp_rad, grasp_rad);
        return target;
    }
    StringArray tensions(double low_n, double high_n) {
        StringArray result{};
        for (double &tension : result) {
            tension = between(low_n, high_n);
        }
        return result;
    }

private:
    std::mt19937 engine_;
};

inline PlantSettings frictionless(bool elastic) {
    PlantSettings settings;
    settings.elastic = elastic;
    settings.coulomb_friction_n = 0.0;
    settings.viscous_friction_n_s_m = 0.0;
    return settings;
}

// current = tension / gain * radius / torque constant.
inline StringArray currents_for(const MotorCalibration &motors, const StringArray &tensions_n) {
    StringArray currents{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        currents[i] = tensions_n[i] / motors.tension_gain[i] * motors.effective_radius_m[i] /
                      motors.torque_constant_nm_a[i];
    }
    return currents;
}

inline void pull(SimulatedPlant &plant, const StringArray &tensions_n) {
    plant.set_currents(currents_for(PlantSettings{}.motors, tensions_n));
}

inline StringArray equal_tensions(double tension_n) {
    StringArray result{};
    result.fill(tension_n);
    return result;
}

// Pole ends written out from the design page: r1 at 45 deg + psi/2 in the grip's x-y plane, r2 at 45 deg - psi/2.
inline double string_length(const PlantSettings &settings, const HandTarget &pose, std::size_t i) {
    const double psi = std::acos(0.0) - pose.grasp_angle_rad;
    const Attachment &tie = settings.grip.attachments[i];
    const double at = std::atan(1.0) + (tie.pole == 0 ? 0.5 : -0.5) * psi;
    const Vec3 end =
        pose.position_m + pose.rotation * (tie.sign * settings.grip.pole_half_length_m *
                                           Vec3(std::cos(at), std::sin(at), 0.0));
    return glm::length(settings.frame.motors_m[i] - end);
}

// A pose moved by h in one degree of freedom (rotation: about the device axes through P0).
inline HandTarget moved(HandTarget pose, std::size_t dof, double h) {
    Vec3 step(0.0);
    if (dof < 6) {
        step[static_cast<int>(dof % 3)] = h;
    }
    if (dof < 3) {
        pose.position_m += step;
    } else if (dof < 6) {
        pose.rotation = rotation_by(step) * pose.rotation;
    } else {
        pose.grasp_angle_rad += h;
    }
    return pose;
}

// Virtual work: the generalised force of tensions on each degree of freedom is -sum T dl/dx.
inline PaperWrench virtual_work_forces(const PlantSettings &settings, const HandTarget &pose,
                                       const StringArray &tensions_n) {
    constexpr double kH = 1e-6; // error of central differences about 1e-10 relative
    PaperWrench result{};
    for (std::size_t dof = 0; dof < kDofCount; ++dof) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double slope = (string_length(settings, moved(pose, dof, kH), i) -
                                  string_length(settings, moved(pose, dof, -kH), i)) /
                                 (2.0 * kH);
            result[dof] -= tensions_n[i] * slope;
        }
    }
    return result;
}

inline HandTarget pose_of(const PlantTruth &truth) {
    return {truth.pose.position_m, truth.frame.rotation, truth.frame.grasp_angle_rad};
}

inline bool is_finite(const PlantTruth &truth) {
    double sum = truth.energy_to_hand_j + truth.frame.grasp_angle_rad;
    for (const double value : lanes(truth.strings)) {
        sum += value;
    }
    for (const double value : lanes(truth.hand)) {
        sum += value;
    }
    for (int axis = 0; axis < 3; ++axis) {
        sum += truth.pose.position_m[axis] + truth.pose.r1_m[axis] + truth.pose.r2_m[axis] +
               truth.twist.linear_m_s[axis] + truth.twist.angular_rad_s[axis];
    }
    return std::isfinite(sum);
}

} // namespace spidar::test
