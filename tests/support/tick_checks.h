// What must hold after every servo step, whatever the test is about: run by the fixtures in each tick.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/geometry/wrench_matrix.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"
#include "device/settings/servo_settings.h"
#include "device/step/tension_diagnosis.h"

namespace spidar::test {

class TickChecks {
public:
    // After step() with this input. A step that was configured anew begins with other checks.
    void check(const ServoSettings &settings, Status read_status, const DeviceReading &reading,
               const DriveCommand &drive, const ServoSnapshot &now, double dt_s) {
        problem_.clear();
        check_state(now, drive);
        check_tensions(settings, drive, now);
        if (drive.motors_on) {
            check_wrench(settings, now);
        } else {
            check_slack(drive, now);
        }
        check_counters(now, dt_s);
        check_reading(read_status, reading, now);
        last_ = now;
        has_last_ = true;
        if (!problem_.empty()) {
            FAIL_CHECK("tick " << now.counters.ticks << ", state "
                               << std::string(describe(now.state)) << ": " << problem_);
        }
    }

private:
    void must(bool holds, const char *what) {
        if (!holds && problem_.empty()) {
            problem_ = what;
        }
    }
    static bool share(double value) { return value >= 0.0 && value <= 1.0; }
    static bool finite(const Wrench &w) {
        return std::isfinite(w.force_n.x + w.force_n.y + w.force_n.z + w.moment_nm.x +
                             w.moment_nm.y + w.moment_nm.z + w.grasp_torque_nm);
    }
    static bool is_zero(const Wrench &w) { return to_paper(w) == PaperWrench(); }

    void check_state(const ServoSnapshot &now, const DriveCommand &drive) {
        must(static_cast<std::size_t>(now.state) < kDeviceStates, "a state that does not exist");
        must((now.state != DeviceState::fault) || now.fault != Status::ok,
             "FAULT without a reason");
        const bool pulls = now.state == DeviceState::arming || now.state == DeviceState::active ||
                           now.state == DeviceState::fading || now.state == DeviceState::taut ||
                           now.state == DeviceState::calibrated;
        must(!pulls || now.fault == Status::ok, "a state that pulls has a fault");
        must(pulls || !drive.motors_on, "the motors are on in a state that does not pull");
        must(now.fault_string >= -1 && now.fault_string < kStringCount, "no such string");
        must(share(now.force_scale) && share(now.tension_scale) && share(now.safety_scale),
             "a scale outside [0, 1]");
        must(now.force_scale <= now.tension_scale, "the wrench is ahead of the tensions");
        must(now.thermal_share >= 0.0 && std::isfinite(now.thermal_share), "heat is no number");
        const GripPose &pose = now.grip.pose;
        must(std::isfinite(pose.position_m.x + pose.position_m.y + pose.position_m.z + pose.r1_m.x +
                           pose.r1_m.y + pose.r1_m.z + pose.r2_m.x + pose.r2_m.y + pose.r2_m.z),
             "the pose is not finite");
        const Twist &twist = now.grip.twist;
        must(std::isfinite(twist.linear_m_s.x + twist.linear_m_s.y + twist.linear_m_s.z +
                           twist.angular_rad_s.x + twist.angular_rad_s.y + twist.angular_rad_s.z +
                           twist.grasp_rate_rad_s),
             "the twist is not finite");
        for (const double work_j : now.injected_j) {
            must(std::isfinite(work_j), "the work is not finite");
        }
    }

    void check_tensions(const ServoSettings &settings, const DriveCommand &drive,
                        const ServoSnapshot &now) {
        const double most_n = solver_settings(settings).max_tension_n;
        const StringArray currents_a = currents_from_tensions(settings.motors, now.tensions_n);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            must(now.tensions_n[i] >= 0.0 && now.tensions_n[i] <= most_n,
                 "a tension outside its bounds");
            must(drive.currents_a[i] >= 0.0 &&
                     drive.currents_a[i] <= settings.motors.max_current_a[i],
                 "a current outside its bounds");
            if (drive.motors_on) {
                must(std::abs(drive.tensions_n[i] * settings.motors.tension_gain[i] -
                              now.tensions_n[i]) <= kRounding,
                     "what is sent is not what is published");
                must(std::abs(drive.currents_a[i] - currents_a[i]) <= kRounding,
                     "a current is not that of its tension");
            }
            const bool broken = ((settings.tension.broken_mask >> i) & 1U) != 0;
            must(!broken || now.tensions_n[i] == 0.0, "a broken string is pulled");
        }
        must((now.at_min_mask & now.at_max_mask) == 0, "a string at both of its bounds");
        must(!drive.clear_faults || !drive.motors_on, "faults are cleared with the motors on");
    }

    // What the strings give is what is said that they give.
    void check_wrench(const ServoSettings &settings, const ServoSnapshot &now) {
        must(finite(now.requested) && finite(now.achieved), "a wrench that is not finite");
        if (now.state == DeviceState::taut) {
            must(is_zero(now.achieved) && is_zero(now.requested), "TAUT asks for no wrench");
            return;
        }
        WrenchMatrix matrix;
        set_wrench_matrix(matrix, settings.frame, settings.grip, now.grip.pose);
        const PaperWrench gives = spidar::apply(matrix, now.tensions_n);
        const PaperWrench said = to_paper(now.achieved);
        for (std::size_t i = 0; i < gives.size(); ++i) {
            must(std::abs(gives[i] - said[i]) <= kWrenchRounding, "achieved is not A tau");
        }
    }

    void check_slack(const DriveCommand &drive, const ServoSnapshot &now) {
        must(now.tensions_n == StringArray() && drive.tensions_n == StringArray() &&
                 drive.currents_a == StringArray(),
             "motors off, and a string is pulled");
        must(is_zero(now.requested) && is_zero(now.achieved), "motors off, and a wrench is told");
        must(now.at_min_mask == 0 && now.at_max_mask == 0 && now.tension_status == Status::ok,
             "motors off, and a bound is told");
    }

    void check_counters(const ServoSnapshot &now, double dt_s) {
        if (!has_last_ || now.counters.ticks < last_.counters.ticks) {
            return; // configured anew
        }
        const ServoCounters &a = last_.counters;
        const ServoCounters &b = now.counters;
        must(b.ticks == a.ticks + 1, "a tick is one tick");
        using Counter = std::uint64_t ServoCounters::*;
        constexpr std::array<std::pair<Counter, const char *>, 12> kOnes{
            {{&ServoCounters::kinematics_skipped, "kinematics_skipped"},
             {&ServoCounters::tension_skipped, "tension_skipped"},
             {&ServoCounters::steps_skipped, "steps_skipped"},
             {&ServoCounters::cold_starts, "cold_starts"},
             {&ServoCounters::bad_samples, "bad_samples"},
             {&ServoCounters::read_timeouts, "read_timeouts"},
             {&ServoCounters::saturated_ticks, "saturated_ticks"},
             {&ServoCounters::slewed_ticks, "slewed_ticks"},
             {&ServoCounters::old_reports, "old_reports"},
             {&ServoCounters::faded_ticks, "faded_ticks"},
             {&ServoCounters::bad_time_steps, "bad_time_steps"},
             {&ServoCounters::write_failures, "write_failures"}}};
        for (const auto &[counter, name] : kOnes) {
            must(b.*counter == a.*counter || b.*counter == a.*counter + 1, name);
        }
        must(b.rejected_requests >= a.rejected_requests &&
                 b.clamped_requests >= a.clamped_requests &&
                 b.expired_requests >= a.expired_requests && b.reports_missed >= a.reports_missed,
             "a counter goes down");
        must(b.gate_clamps == a.gate_clamps, "an impossible tension reached the gate");
        const bool odd_step = b.bad_time_steps != a.bad_time_steps;
        const double passed_s = now.time_s - last_.time_s;
        must(odd_step ? passed_s > 0.0 : std::abs(passed_s - dt_s) <= kTimeRounding,
             "the clock does not go by the step");
    }

    // A sample that was used is the one that came in.
    void check_reading(Status read_status, const DeviceReading &reading, const ServoSnapshot &now) {
        const ServoCounters &a = last_.counters;
        const ServoCounters &b = now.counters;
        const bool used = read_status == Status::ok && has_last_ && now.zero_known &&
                          last_.zero_known && usable(now.grip.status) &&
                          now.grip.status != Status::held_last_pose &&
                          b.bad_samples == a.bad_samples && b.old_reports == a.old_reports;
        must(!used || now.counts == reading.counts, "the counts are not those of the reading");
        must(!used || now.buttons == reading.buttons, "the buttons are not those of the reading");
    }

    static constexpr double kRounding = 1e-12;
    static constexpr double kWrenchRounding = 1e-11;
    static constexpr double kTimeRounding = 1e-9;

    ServoSnapshot last_;
    bool has_last_ = false;
    std::string problem_;
};

} // namespace spidar::test
