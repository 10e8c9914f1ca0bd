// The simulated device: target of its hand, true state, and faults.
#include "godot/device/spidar_g.h"

#include <memory>
#include <string>

#include "core/base/finite.h"
#include "godot/base/type_conversions.h"

namespace {

// Largest values of a hand target: larger ones are unit errors and would make the simulation
// diverge.
constexpr double kFarthestHand_m = 10.0;
constexpr double kWidestGrasp_rad = 3.2;

} // namespace

std::unique_ptr<spidar::Transport> SpidarG::simulated_transport(spidar::Status &status,
                                                                std::string &problem) {
    const std::string device_name = config_or_default().get_device_name().utf8().get_data();
    if (!claim_.take(device_name, name_for_messages())) {
        status = spidar::Status::device_in_use;
        problem = "SpidarGConfig.device_name = \"" + device_name +
                  "\": the node that owns this device is \"" +
                  spidar::DeviceClaim::owner_of(device_name) +
                  "\". Free that node, or give this one another device_name.";
        return nullptr;
    }
    auto transport = std::make_unique<spidar::SimulatedTransport>(plant_);
    use_strings(transport->home_counts(), plant_.metres_per_count);
    simulated_ = transport.get();
    if (config_or_default().get_grasp_source() == SpidarGConfig::GRASP_AUTOMATIC) {
        spidar::FingerSettings &fingers = settings_.fingers;
        fingers.sensor = static_cast<int>(spidar::kSqueezeSensor);
        fingers.sensor_open = 0.0;
        fingers.sensor_closed = spidar::kSqueeze_1_rad * fingers.closed_rad;
    }
    return transport;
}

bool SpidarG::set_simulated_hand_target(const godot::Transform3D &target, double grasp_angle) {
    if (simulated_ == nullptr) {
        return false; // other transports have a real hand
    }
    const spidar::WorldFrame frame = world();
    const spidar::Vec3 origin = spidar::to_core(target.origin);
    const spidar::Mat3 turn = spidar::to_core(target.basis.orthonormalized());
    if (!spidar::all_finite(origin, turn, grasp_angle)) {
        return reject(
            "set_simulated_hand_target: target or grasp_angle = " + std::to_string(grasp_angle) +
            " rad is not finite: give finite numbers; the hand keeps its target.");
    }
    const double away_m = glm::length(frame.point_to_device(origin));
    if (!(away_m <= kFarthestHand_m) || std::abs(grasp_angle) > kWidestGrasp_rad) {
        return reject("set_simulated_hand_target: the target is " + std::to_string(away_m) +
                      " m (of the device) from the frame's center, grasp_angle = " +
                      std::to_string(grasp_angle) +
                      " rad: give at most 10 m and -3.2 to 3.2 rad; the hand keeps its target.");
    }
    simulated_->set_hand_target(
        {frame.point_to_device(origin), glm::transpose(frame.rotation) * turn, grasp_angle});
    return true;
}

void SpidarG::set_simulated_hand_firmness(HandFirmness firmness) {
    if (firmness < HAND_LIGHT || firmness > HAND_FIRM) {
        refuse("simulated_hand_firmness = " + std::to_string(static_cast<int>(firmness)) +
               ": give one of SpidarG.HandFirmness, 0 to 2; the old value stays.");
        return;
    }
    if (simulated_ != nullptr) {
        simulated_->set_hand_firmness(static_cast<spidar::HandFirmness>(firmness));
    }
}

godot::Dictionary SpidarG::get_simulated_truth() const {
    godot::Dictionary truth;
    if (simulated_ == nullptr) {
        return truth;
    }
    const spidar::PlantTruth plant = simulated_->truth();
    const spidar::WorldFrame frame = world();
    truth["grip_transform"] = frame.pose_to_world(plant.pose.position_m, plant.frame.rotation);
    // Positions as doubles too: a Vector3 rounds at some tens of nanometers.
    truth["position_m"] = spidar::to_godot(std::array<double, 3>{
        plant.pose.position_m.x, plant.pose.position_m.y, plant.pose.position_m.z});
    // The fingers of a rigid grip are not held by strings.
    truth["grasp_angle"] = settings_.grip.kind == spidar::GripKind::rigid
                               ? get_grasp_angle()
                               : plant.frame.grasp_angle_rad;
    truth["strings_wrench"] = spidar::to_godot(frame.wrench_to_world(plant.strings));
    truth["hand_wrench"] = spidar::to_godot(frame.wrench_to_world(plant.hand));
    truth["twist"] = spidar::to_godot(frame.wrench_to_world(
        {plant.twist.linear_m_s, plant.twist.angular_rad_s, plant.twist.grasp_rate_rad_s}));
    truth["string_tensions"] = spidar::to_godot(plant.tensions_n);
    truth["string_lengths"] = spidar::to_godot(plant.lengths_m);
    truth["energy_to_hand_j"] = plant.energy_to_hand_j;
    truth["time_s"] = plant.time_s;
    return truth;
}

bool SpidarG::inject_simulated_fault(SimulatedFault fault, int string, double start_s,
                                     double duration_s) {
    if (simulated_ == nullptr) {
        return reject(
            "inject_simulated_fault: the open device is not simulated: set transport = Simulated.");
    }
    const spidar::FaultInjection injection{static_cast<spidar::SimulatedFault>(fault), string,
                                           start_s, duration_s};
    if (fault < FAULT_OUTPUT_CUT || fault > FAULT_BLOCKED_OUTPUT || !spidar::is_usable(injection)) {
        return reject(
            "inject_simulated_fault: fault = " + std::to_string(static_cast<int>(fault)) +
            ", string = " + std::to_string(string) + ", start_s = " + std::to_string(start_s) +
            " s, duration_s = " + std::to_string(duration_s) +
            " s: give one of SpidarG.SimulatedFault, a string index from 0 to 7, a start of 0 s or "
            "later and a finite duration.");
    }
    return simulated_->inject(injection) ||
           reject("inject_simulated_fault: " + std::to_string(spidar::kMaxFaults) +
                  " faults are pending or active already: call clear_simulated_faults() first.");
}

void SpidarG::clear_simulated_faults() {
    if (simulated_ != nullptr) {
        simulated_->clear_faults();
    }
}
