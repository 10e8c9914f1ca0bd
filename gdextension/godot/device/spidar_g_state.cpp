// State of the newest snapshot in world coordinates.
#include "godot/device/spidar_g.h"

#include <cmath>

#include <glm/geometric.hpp>

#include <godot_cpp/core/error_macros.hpp>

#include "device/step/tension_diagnosis.h"
#include "godot/base/type_conversions.h"

using spidar::Vec3;

namespace {

[[nodiscard]] bool is_string(int string) {
    return string >= 0 && string < spidar::kStringCount;
}

} // namespace

SpidarG::State SpidarG::get_state() const {
    return static_cast<State>(snapshot_.state);
}

godot::String SpidarG::get_state_text() const {
    const std::string state = spidar::describe(snapshot_.state);
    if (!loop_) {
        return spidar::to_godot(state);
    }
    const char *const kind = simulated_ != nullptr ? "Simulated device: "
                             : replay_ != nullptr  ? "Replay: "
                                                   : "Real device: ";
    return spidar::to_godot(kind + state);
}

godot::String SpidarG::get_fault_text() const {
    return spidar::to_godot(fault_message());
}

double SpidarG::get_device_time() const {
    return earlier_time_s_ + snapshot_.time_s;
}

godot::Transform3D SpidarG::get_grip_transform() const {
    const spidar::GripState &grip = snapshot_.grip;
    return world().pose_to_world(grip.pose.position_m, grip.frame.rotation);
}

godot::Transform3D SpidarG::get_pole_transform(int pole) const {
    ERR_FAIL_COND_V_MSG(pole != 0 && pole != 1, godot::Transform3D(),
                        "SpidarG.get_pole_transform: give 0 (r1) or 1 (r2) as the pole.");
    const spidar::GripState &grip = snapshot_.grip;
    const Vec3 along = glm::normalize(pole == 0 ? grip.pose.r1_m : grip.pose.r2_m);
    const Vec3 normal = grip.frame.rotation[2];
    // r lies in the grip's x-y plane; with parallel poles the held normal may not be exactly
    // perpendicular to it.
    const Vec3 across = glm::normalize(glm::cross(normal, along));
    return world().pose_to_world(grip.pose.position_m,
                                 spidar::Mat3(along, across, glm::cross(along, across)));
}

godot::Vector3 SpidarG::get_pole_end(ContactTarget target) const {
    ERR_FAIL_COND_V_MSG(target < CONTACT_CENTER || target > CONTACT_TURN_STOP, godot::Vector3(),
                        "SpidarG.get_pole_end: give one of SpidarG.ContactTarget as the target.");
    const spidar::GripPose &pose = snapshot_.grip.pose;
    Vec3 point = pose.position_m;
    switch (target) {
    case CONTACT_POLE1_PLUS:
        point += pose.r1_m;
        break;
    case CONTACT_POLE1_MINUS:
        point -= pose.r1_m;
        break;
    case CONTACT_POLE2_PLUS:
        point += pose.r2_m;
        break;
    case CONTACT_POLE2_MINUS:
        point -= pose.r2_m;
        break;
    case CONTACT_CENTER:
    case CONTACT_GRASP_STOP:
    case CONTACT_TURN_STOP:
        break;
    }
    return spidar::to_godot(world().point_to_world(point));
}

godot::Vector3 SpidarG::get_string_start(int string) const {
    ERR_FAIL_COND_V_MSG(!is_string(string), godot::Vector3(),
                        "SpidarG.get_string_start: give a string index from 0 to 7.");
    return spidar::to_godot(
        world().point_to_world(settings_.frame.motors_m[static_cast<std::size_t>(string)]));
}

godot::Vector3 SpidarG::get_string_end(int string) const {
    ERR_FAIL_COND_V_MSG(!is_string(string), godot::Vector3(),
                        "SpidarG.get_string_end: give a string index from 0 to 7.");
    return spidar::to_godot(world().point_to_world(
        spidar::attachment_point(settings_.grip, snapshot_.grip.pose, string)));
}

double SpidarG::get_grasp_angle() const {
    return snapshot_.grip.frame.grasp_angle_rad;
}

double SpidarG::get_grasp_rate() const {
    return snapshot_.grip.twist.grasp_rate_rad_s;
}

SpidarG::GraspPhase SpidarG::get_grasp_phase() const {
    return static_cast<GraspPhase>(snapshot_.grasp);
}

double SpidarG::get_jaw_gap() const {
    return config_or_default().jaw_gap(get_grasp_angle());
}

double SpidarG::get_grasp_angle_for_gap(double gap_m) const {
    ERR_FAIL_COND_V_MSG(
        !std::isfinite(gap_m), 0.0,
        "SpidarG.get_grasp_angle_for_gap: give a finite number in meters as gap_m.");
    return config_or_default().grasp_angle_for_gap(gap_m);
}

godot::Vector3 SpidarG::get_linear_velocity() const {
    const spidar::WorldFrame frame = world();
    const Vec3 from_node = frame.point_to_world(snapshot_.grip.pose.position_m) - frame.origin;
    return spidar::to_godot(frame.velocity_to_world(snapshot_.grip.twist.linear_m_s) +
                            motion_.velocity_at(from_node));
}

godot::Vector3 SpidarG::get_angular_velocity() const {
    return spidar::to_godot(world().turn_to_world(snapshot_.grip.twist.angular_rad_s) +
                            motion_.angular_rad_s());
}

godot::PackedFloat64Array SpidarG::get_string_lengths() const {
    return spidar::to_godot(snapshot_.lengths_m);
}

godot::PackedFloat64Array SpidarG::get_string_tensions() const {
    return spidar::to_godot(snapshot_.tensions_n);
}

godot::PackedInt32Array SpidarG::get_encoder_counts() const {
    return spidar::to_godot(snapshot_.counts);
}

godot::PackedFloat64Array SpidarG::get_requested_wrench() const {
    return spidar::to_godot(world().wrench_to_world(snapshot_.requested));
}

godot::PackedFloat64Array SpidarG::get_achieved_wrench() const {
    return spidar::to_godot(world().wrench_to_world(snapshot_.achieved));
}

godot::PackedFloat64Array SpidarG::get_wrench_bias() const {
    return spidar::to_godot(
        world().wrench_to_world(spidar::from_paper(tension_report(settings_, snapshot_).bias())));
}

godot::Dictionary SpidarG::get_contact_impulses(const godot::String &owner) const {
    godot::Dictionary impulses;
    const std::string name = owner.utf8().get_data();
    const spidar::WorldFrame frame = world();
    for (int i = 0; i < snapshot_.contact_count; ++i) {
        const spidar::ContactReport &contact = snapshot_.contacts[static_cast<std::size_t>(i)];
        const bool is_stop = contact.grasp_impulse_nms != 0.0;
        std::int32_t id = 0;
        if (!requests_.id_of(name, contact.id, id)) {
            continue;
        }
        impulses[id] =
            is_stop
                ? godot::Vector3(static_cast<spidar::GodotReal>(contact.grasp_impulse_nms), 0, 0)
                : spidar::to_godot(frame.turn_to_world(contact.impulse_ns));
    }
    return impulses;
}

godot::PackedInt32Array SpidarG::get_touching_contacts(const godot::String &owner) const {
    godot::PackedInt32Array ids;
    const std::string name = owner.utf8().get_data();
    for (int i = 0; i < snapshot_.contact_count; ++i) {
        const spidar::ContactReport &contact = snapshot_.contacts[static_cast<std::size_t>(i)];
        std::int32_t id = 0;
        if (contact.touching && requests_.id_of(name, contact.id, id)) {
            ids.push_back(id);
        }
    }
    return ids;
}

godot::PackedInt32Array SpidarG::get_lateness_histogram() const {
    godot::PackedInt32Array counts;
    if (!loop_) {
        return counts;
    }
    counts.resize(spidar::LoopHistogram::kBuckets);
    std::int32_t *out = counts.ptrw();
    for (const std::uint32_t count : loop_->lateness_counts()) {
        *out = static_cast<std::int32_t>(count & INT32_MAX);
        ++out;
    }
    return counts;
}

godot::Dictionary SpidarG::get_statistics() const {
    godot::Dictionary statistics;
    const spidar::LoopStatistics loop = loop_ ? loop_->statistics() : spidar::LoopStatistics{};
    const spidar::ServoCounters &count = snapshot_.counters;
    statistics["servo_rate_hz"] = loop.measured_rate_hz;
    statistics["step_p50_us"] = loop.step_p50_us;
    statistics["step_p99_us"] = loop.step_p99_us;
    statistics["lateness_p50_us"] = loop.lateness_p50_us;
    statistics["lateness_p99_us"] = loop.lateness_p99_us;
    statistics["lateness_max_us"] = loop.lateness_max_us;
    statistics["missed_deadlines"] = spidar::whole(loop.missed_deadlines);
    statistics["late_cycles"] = spidar::whole(loop.late_cycles);
    statistics["reports_missed"] = spidar::whole(count.reports_missed);
    statistics["old_reports"] = spidar::whole(count.old_reports);
    statistics["faded_ticks"] = spidar::whole(count.faded_ticks);
    statistics["safety_scale"] = snapshot_.safety_scale;
    statistics["thermal_share"] = snapshot_.thermal_share;
    statistics["parity_error_m"] = snapshot_.parity_error_m;
    statistics["zero_known"] = snapshot_.zero_known;
    statistics["real_time_priority"] = loop.real_time_priority;
    statistics["ticks"] = spidar::whole(count.ticks);
    statistics["kinematics_skipped"] = spidar::whole(count.kinematics_skipped);
    statistics["tension_skipped"] = spidar::whole(count.tension_skipped);
    statistics["steps_skipped"] = spidar::whole(count.steps_skipped);
    const spidar::TouchReport &touch = snapshot_.touch;
    statistics["touch_points"] = touch.point_count;
    statistics["touch_pairs"] = touch.queries;
    statistics["touch_skipped"] = spidar::whole(touch.skipped);
    statistics["cold_starts"] = spidar::whole(count.cold_starts);
    statistics["bad_samples"] = spidar::whole(count.bad_samples);
    statistics["read_timeouts"] = spidar::whole(count.read_timeouts);
    statistics["rejected_requests"] = spidar::whole(count.rejected_requests);
    statistics["clamped_requests"] = spidar::whole(count.clamped_requests);
    statistics["expired_requests"] = spidar::whole(count.expired_requests);
    statistics["saturated_ticks"] = spidar::whole(count.saturated_ticks);
    statistics["slewed_ticks"] = spidar::whole(count.slewed_ticks);
    statistics["write_failures"] = spidar::whole(count.write_failures);
    statistics["force_scale"] = snapshot_.force_scale;
    statistics["residual_m"] = snapshot_.grip.residual_rms_m;
    statistics["conditioning"] = snapshot_.grip.conditioning;
    statistics["pose_status"] = godot::String(spidar::describe(snapshot_.grip.status));
    statistics["at_min_mask"] = static_cast<std::int64_t>(snapshot_.at_min_mask);
    statistics["at_max_mask"] = static_cast<std::int64_t>(snapshot_.at_max_mask);
    return statistics;
}
