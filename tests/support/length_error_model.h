// What a real string does to its length, all at once, in time: pulley exit, stretch, creep,
// hysteresis, friction, winding build-up, uneven lay, encoder. A model of its own beside the
// simulated plant, for the error budget. Values are those of the simulated device where it has
// them; the rest is an estimate of a 0.3 mm braid.
#pragma once

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/calibration/fit/string_scale_fit.h"
#include "device/simulation/drum_winding.h"
#include "support/motion_samples.h"

namespace spidar::test {

struct LengthErrors {
    double pulley_radius_m = 0.004;  // swivelling exit pulley; 0: eyelet
    double axial_stiffness_n = 3000; // EA
    double creep = 0.002;            // strain at 10 N (tension_max) after a long time
    double creep_s = 60.0;
    double hysteresis = 0.05; // share of the elastic strain that follows late
    double hysteresis_s = 2.0;
    double friction_n = 0.1; // Coulomb, between motor and string
    double build_up = 0.046; // growth of the winding radius over 0.7 m (paper, Table 1)
    double lay_m = 5e-5;     // uneven winding, rms a turn
    double noise_m = 2e-5;   // vibration
};

inline constexpr double kTurn_m = 0.05; // 2 pi * 8 mm
inline constexpr double kCreepTension_n = 10.0;

class StringModel {
public:
    StringModel(const LengthErrors &errors, const Vec3 &exit_m, double scale_m_per_count,
                Draw &draw)
        : errors_(errors), exit_m_(exit_m), scale_(scale_m_per_count) {
        for (double &lay : lay_) {
            lay = errors.lay_m * draw.normal();
        }
    }

    // Path of the string from the pulley's fixed point to the attachment. The pulley swivels about
    // the frame's Y through its inlet point, which is where the eyelet would be.
    [[nodiscard]] double path_m(const Vec3 &attachment_m) const {
        const double r = errors_.pulley_radius_m;
        const Vec3 line = attachment_m - exit_m_;
        if (r <= 0.0) {
            return glm::length(line);
        }
        const double along = line.y * std::copysign(1.0, exit_m_.y);
        const double out = std::hypot(line.x, line.z) - r;
        const double distance = std::hypot(out, along);
        const double departure = std::atan2(along, out) + std::acos(r / distance);
        return r * (3.141592653589793 - departure) + std::sqrt(distance * distance - r * r);
    }

    // One time step; returns the counts that the encoder shows.
    std::int32_t step(const Vec3 &attachment_m, double commanded_n, double dt_s, Draw &draw) {
        const double path = path_m(attachment_m);
        const double speed = started_ ? (path - last_path_m_) / dt_s : 0.0;
        last_path_m_ = path;
        // Friction holds the string back: more tension while it is pulled out.
        const double tension =
            std::fmax(0.0, commanded_n + errors_.friction_n * std::tanh(speed / 0.01));
        const double elastic = tension / errors_.axial_stiffness_n;
        const double creep = errors_.creep * tension / kCreepTension_n;
        if (!started_) {
            late_ = elastic;
            crept_ = creep;
            started_ = true;
        }
        late_ += (elastic - late_) * std::fmin(1.0, dt_s / errors_.hysteresis_s);
        crept_ += (creep - crept_) * std::fmin(1.0, dt_s / errors_.creep_s);
        const double strain =
            (1.0 - errors_.hysteresis) * elastic + errors_.hysteresis * late_ + crept_;
        const double unstretched = path / (1.0 + strain) + errors_.noise_m * draw.normal();
        if (!zeroed_) {
            zero_m_ = unstretched;
            zeroed_ = true;
        }
        // Paid out since the zero: the drum shrinks as string leaves it.
        const double wound = unstretched - zero_m_ + lay(unstretched);
        const double paid_out = DrumWinding{errors_.build_up}.turned_m(wound);
        return static_cast<std::int32_t>(std::lround(paid_out / scale_));
    }

private:
    [[nodiscard]] double lay(double length_m) const { // the same at each turn of the drum
        const double turn = std::fmin(std::fmax(length_m / kTurn_m, 0.0), kTurns - 2.0);
        const auto k = static_cast<std::size_t>(turn);
        const double part = turn - static_cast<double>(k);
        return (1.0 - part) * lay_[k] + part * lay_[k + 1];
    }

    static constexpr int kTurns = 24;
    LengthErrors errors_;
    Vec3 exit_m_;
    double scale_;
    std::array<double, kTurns> lay_{};
    double last_path_m_ = 0.0;
    double late_ = 0.0;
    double crept_ = 0.0;
    double zero_m_ = 0.0;
    bool started_ = false;
    bool zeroed_ = false;
};

// The whole device: eight such strings on a frame and grip that are not quite as built on paper.
class ErrorModelDevice {
public:
    ErrorModelDevice(const LengthErrors &errors, double build_error_m, Draw &draw) {
        // The x size of the frame is the true length given to the calibration.
        truth_.frame = make_box_frame(Vec3(kPaperHalfExtent_m,
                                           kPaperHalfExtent_m + build_error_m * draw.normal(),
                                           kPaperHalfExtent_m + build_error_m * draw.normal()));
        truth_.grip.pole_half_length_m += 0.2 * build_error_m * draw.normal();
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double scale = kPaperMetresPerCount * 1.023 * (1.0 + 0.005 * draw.normal());
            strings_.emplace_back(errors, truth_.frame.motors_m[i], scale, draw);
        }
    }
    [[nodiscard]] const GripGeometry &grip() const { return truth_.grip; }
    CountArray step(const GripPose &pose, const StringArray &tensions_n, double dt_s, Draw &draw) {
        CountArray counts{};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const Vec3 tie = attachment_point(truth_.grip, pose, static_cast<int>(i));
            counts[i] = strings_[i].step(tie, tensions_n[i], dt_s, draw);
        }
        return counts;
    }

    // String i on the bench: pulled straight out to lengths read off a ruler, trial after trial.
    std::vector<CountLengthPair> bench(std::size_t i, double tension_n, double ruler_m,
                                       Draw &draw) {
        std::vector<CountLengthPair> pairs;
        const Vec3 exit = truth_.frame.motors_m[i];
        const Vec3 inwards = -glm::normalize(exit);
        for (int trial = 0; trial < kBenchTrials; ++trial) {
            for (int point = 0; point <= kBenchPoints; ++point) {
                // About the home length, so that the slope is the one at home.
                const double length = 0.2 + 0.38 * point / kBenchPoints;
                const Vec3 tie = exit + length * inwards;
                std::int32_t count = 0;
                for (int k = 0; k < 200; ++k) { // held for a second
                    count = strings_[i].step(tie, tension_n, 0.005, draw);
                }
                pairs.push_back({count, strings_[i].path_m(tie) + ruler_m * draw.normal()});
            }
        }
        return pairs;
    }

private:
    static constexpr int kBenchTrials = 3;
    static constexpr int kBenchPoints = 7;
    DeviceModel truth_;
    std::vector<StringModel> strings_;
};

} // namespace spidar::test
