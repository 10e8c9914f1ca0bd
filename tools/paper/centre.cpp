// "Minimized inertia", "no backlash", "smooth": what the hand meets at and near the centre. Inertia and
// friction are those of the simulated device (PlantSettings), no real one having been at hand.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/tension/tension_solver.h"
#include "device/simulation/simulated_plant.h"
#include "paper/closure.h"
#include "paper/paper_device.h"
#include "paper/sections.h"
#include "paper/wrench_capacity.h"

namespace spidar::paper {

namespace {

constexpr const char *kDofs[] = {"x",          "y",          "z",          "rotation_x",
                                 "rotation_y", "rotation_z", "grasp_angle"};

// Rates of the strings for a unit rate of one DOF. The grasp rate is twice the rate that the paper's g
// is conjugate to.
StringArray string_rates(const WrenchMatrix &matrix, std::size_t dof) {
    PaperTwist rates{};
    rates[dof] = dof == 6 ? 0.5 : 1.0;
    return apply_transposed(matrix, rates);
}

void inertia_and_wrench(const PaperDevice &device, Outputs &outputs) {
    const PlantSettings plant;
    const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, rest_pose(device.grip));
    CsvFile table = outputs.table(
        "centre", "dof,unit_inertia,grip_inertia,rotor_inertia,unit_wrench,coulomb_friction,"
                  "largest_5_n,largest_10_n,largest_20_n");
    double coupling = 0.0; // largest product of two DOFs' string rates, as a part of their own
    for (std::size_t dof = 0; dof < kDofCount; ++dof) {
        const StringArray rates = string_rates(matrix, dof);
        const double grip = dof < 3   ? plant.grip_mass_kg
                            : dof < 6 ? plant.grip_inertia_kg_m2
                                      : plant.grasp_inertia_kg_m2;
        double rotors = 0.0;
        double friction = 0.0;
        for (const double rate : rates) {
            rotors += plant.rotor_mass_kg * rate * rate;
            friction += plant.coulomb_friction_n * std::abs(rate);
        }
        for (std::size_t other = dof + 1; other < kDofCount; ++other) {
            const StringArray other_rates = string_rates(matrix, other);
            double product = 0.0;
            double other_square = 0.0;
            for (std::size_t i = 0; i < rates.size(); ++i) {
                product += rates[i] * other_rates[i];
                other_square += other_rates[i] * other_rates[i];
            }
            coupling =
                std::max(coupling, std::abs(product) /
                                       std::sqrt(rotors / plant.rotor_mass_kg * other_square));
        }
        std::array<double, 3> most{};
        for (std::size_t k = 0; k < most.size(); ++k) {
            const double sum_n = kMaxTensions_n[k] * kStringCount; // no wrench is larger
            PaperWrench plus{};
            PaperWrench minus{};
            plus[dof] = dof == 6 ? 2.0 : 1.0; // g = 2 grasp_torque
            minus[dof] = -plus[dof];
            most[k] = std::fmin(largest_exact(matrix, plus, device.grip.pole_half_length_m,
                                              kMaxTensions_n[k], sum_n),
                                largest_exact(matrix, minus, device.grip.pole_half_length_m,
                                              kMaxTensions_n[k], sum_n));
        }
        table.row({kDofs[dof], dof < 3 ? "kg" : "kg m^2", grip, rotors, dof < 3 ? "N" : "N m",
                   friction, most[0], most[1], most[2]});
        const std::string name = std::string("/") + kDofs[dof];
        outputs.figure("centre_inertia" + name, grip + rotors);
        outputs.figure("centre_friction" + name, friction);
        outputs.figure("centre_largest_10_n" + name, most[1]);
    }
    outputs.figure("centre_inertia_coupling", coupling);
}

// 3 N along X held while the grip moves along X at 0.1 m/s, at the shipped settings.
void smoothness(const PaperDevice &device, Outputs &outputs) {
    constexpr double kTick_m = 1e-4;
    constexpr int kTicks = 4000;
    CsvFile table = outputs.table("smoothness", "x_cm,force_x_n,largest_step_n,closed");
    TensionSolver solver;
    PaperWrench wrench{};
    wrench[0] = 3.0;
    StringArray last{};
    double inside = 0.0;
    double outside = 0.0;
    double step_here = 0.0;
    for (int tick = 0; tick <= kTicks; ++tick) {
        const double x_m = -kCubeHalf_m + tick * kTick_m;
        const GripPose pose = make_pose(device.grip, Vec3(x_m, 0.0, 0.0), Mat3(1.0), 0.0);
        const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, pose);
        const bool closed = closure_of(matrix, device.grip.pole_half_length_m).closed;
        const TensionResult result = solver.update(matrix, wrench);
        for (std::size_t i = 0; i < last.size() && tick > 0; ++i) {
            step_here = std::fmax(step_here, std::abs(result.tensions_n[i] - last[i]));
        }
        last = result.tensions_n;
        (closed ? inside : outside) = std::fmax(closed ? inside : outside, step_here);
        if (tick % 25 == 0) {
            table.row({100.0 * x_m, apply(matrix, result.tensions_n)[0], step_here, closed});
        }
        step_here = tick % 25 == 0 ? 0.0 : step_here;
    }
    outputs.figure("smooth_step_inside_n", inside);
    outputs.figure("smooth_step_outside_n", outside);
}

// Strings that never go slack have no backlash; what it costs is the wrench left when none is asked for.
void taut_strings(const PaperDevice &device, Outputs &outputs) {
    constexpr int kPoses = 20000;
    CsvFile table = outputs.table("free_hand", "poses,least_tension_n,force_rms_n,force_max_n,"
                                               "moment_rms_nm,moment_max_nm");
    struct Case {
        const char *poses;
        double cube_m;
        double tilt_deg;
    };
    for (const Case &one :
         {Case{"10 cm cube; tilt 10 deg", 0.05, 10.0}, Case{"20 cm cube; tilt 20 deg", 0.10, 20.0},
          Case{"40 cm cube; tilt 30 deg", 0.20, 30.0}}) {
        Random random(4);
        double least = 1e9;
        double force_squares = 0.0;
        double force_most = 0.0;
        double moment_squares = 0.0;
        double moment_most = 0.0;
        for (int i = 0; i < kPoses; ++i) {
            const double tilt = one.tilt_deg * kDegree_rad;
            const GripPose pose = random.pose(device.grip, one.cube_m, tilt, tilt);
            TensionSolver solver;
            const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, pose);
            const TensionResult result = solver.update(matrix, PaperWrench{});
            const PaperWrench q = apply(matrix, result.tensions_n);
            const double force = std::hypot(q[0], q[1], q[2]);
            const double moment = std::hypot(q[3], q[4], q[5]);
            least = std::min(least,
                             *std::min_element(result.tensions_n.begin(), result.tensions_n.end()));
            force_squares += force * force;
            force_most = std::fmax(force_most, force);
            moment_squares += moment * moment;
            moment_most = std::fmax(moment_most, moment);
        }
        const double force_rms = std::sqrt(force_squares / kPoses);
        table.row({one.poses, least, force_rms, force_most, std::sqrt(moment_squares / kPoses),
                   moment_most});
        outputs.figure(std::string("free_hand_least_tension_n/") + one.poses, least);
        outputs.figure(std::string("free_hand_force_rms_n/") + one.poses, force_rms);
        outputs.figure(std::string("free_hand_force_max_n/") + one.poses, force_most);
    }
}

} // namespace

void centre(Outputs &outputs) {
    const PaperDevice device;
    inertia_and_wrench(device, outputs);
    smoothness(device, outputs);
    taut_strings(device, outputs);
}

} // namespace spidar::paper
