// The whole loop in simulated time with what a real one adds: a link that delays, and a game that publishes late,
// with jitter, and drops frames. Bare plant and servo step, so that nothing else stands between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "device/contact/touch/touch_scene.h"
#include "device/simulation/simulated_plant.h"
#include "device/step/servo_step.h"

namespace spidar::test {

struct RigSettings {
    PlantSettings plant;
    ServoSettings servo;      // strings are filled in
    double latency_s = 0.001; // from the encoders' sample to the motors' command
    double game_hz = 60.0;
    // A frame's answer comes this part of its period after what it looked at; jitter is added, uniform.
    double game_work = 0.18;
    double game_jitter = 0.0;
    double dropped_frames = 0.0; // probability
    std::uint64_t seed = 1;
};

// Smallest and largest of a motion.
struct Extent {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    [[nodiscard]] double size() const { return most >= least ? most - least : 0.0; }
};

class HapticRig {
public:
    // Looks at a snapshot and fills in the next command's requests; bumps their sequences itself.
    using Game = std::function<void(const ServoSnapshot &, HapticCommand &)>;

    explicit HapticRig(const RigSettings &settings)
        : settings_(settings), plant_(settings.plant), random_(settings.seed) {
        settings_.servo.strings =
            calibrate_at_home(string_lengths(settings_.servo.frame, settings_.servo.grip,
                                             rest_pose(settings_.servo.grip)),
                              plant_.counts(), settings_.plant.metres_per_count);
        settings_.servo.safety.arming_time_s = kArming_s;
        settings_.servo.render.latency_s = settings.latency_s;
        step_.use(&memory_);
        started_ = step_.configure(settings_.servo);
        command_.forces_enabled = true;
        pending_ = command_;
        plant_steps_per_tick_ = std::lround(kPlantRate_hz / settings_.servo.rate_hz);
        latency_steps_ = std::lround(settings.latency_s * kPlantRate_hz);
        run(2.0 * kArming_s);
        start_ = plant_.truth();
    }

    Game game;
    // Called once a servo cycle, before the plant moves on.
    std::function<void(const ServoSnapshot &, const PlantTruth &)> watch;

    // Forces are on and nothing went wrong.
    [[nodiscard]] bool active() const {
        return usable(started_) && step_.snapshot().state == DeviceState::active &&
               plant_.truth().resets == 0;
    }
    [[nodiscard]] const ServoSnapshot &now() const { return step_.snapshot(); }
    [[nodiscard]] PlantTruth truth() const { return plant_.truth(); }
    [[nodiscard]] double time_s() const { return static_cast<double>(ticks_) / rate(); }
    // Work of the strings on the hand since the rig was active (unit: J).
    [[nodiscard]] double energy_to_hand_j() const {
        return plant_.truth().energy_to_hand_j - start_.energy_to_hand_j;
    }
    void hand_to(const HandTarget &target) { plant_.set_hand_target(target); }

    void run(double duration_s) {
        const auto ticks = static_cast<long>(std::llround(duration_s * rate()));
        for (long i = 0; i < ticks; ++i) {
            tick();
        }
    }

private:
    static constexpr double kArming_s = 0.05;

    [[nodiscard]] double rate() const { return settings_.servo.rate_hz; }

    void tick() {
        play();
        DeviceReading reading;
        reading.counts = plant_.counts();
        const DriveCommand drive = step_.step(Status::ok, reading, command_, 1.0 / rate(), true);
        if (watch) {
            watch(step_.snapshot(), plant_.truth());
        }
        const long now = ticks_ * plant_steps_per_tick_;
        on_the_way_.push_back({now + latency_steps_, drive.currents_a});
        long at = now;
        const long end = now + plant_steps_per_tick_;
        while (at < end) {
            while (!on_the_way_.empty() && on_the_way_.front().due <= at) {
                plant_.set_currents(on_the_way_.front().currents_a);
                on_the_way_.pop_front();
            }
            const long until = on_the_way_.empty() ? end : std::min(end, on_the_way_.front().due);
            plant_.advance(static_cast<double>(until - at) / kPlantRate_hz);
            at = until;
        }
        ++ticks_;
    }

    // The game looks at a frame's start and publishes within it.
    void play() {
        const double period_s = 1.0 / settings_.game_hz;
        const double t = time_s();
        if (t + 1e-9 >= next_frame_s_) {
            next_frame_s_ += period_s;
            const double chance = uniform_(random_);
            const double late = settings_.game_work + settings_.game_jitter * uniform_(random_);
            if (game && !(chance < settings_.dropped_frames)) {
                pending_ = command_;
                pending_.contacts_state_time_s = step_.snapshot().time_s;
                game(step_.snapshot(), pending_);
                publish_s_ = t + std::min(late, 0.95) * period_s;
                waiting_ = true;
            }
        }
        if (waiting_ && t + 1e-9 >= publish_s_) {
            command_ = pending_;
            waiting_ = false;
        }
    }

    struct Order {
        long due;
        StringArray currents_a;
    };

    RigSettings settings_;
    SimulatedPlant plant_;
    ProxyMemory memory_;
    ServoStep step_;
    std::mt19937_64 random_;
    std::uniform_real_distribution<double> uniform_{0.0, 1.0};
    Status started_ = Status::not_open;
    HapticCommand command_;
    HapticCommand pending_;
    PlantTruth start_;
    std::deque<Order> on_the_way_;
    long plant_steps_per_tick_ = 40;
    long latency_steps_ = 0;
    long ticks_ = 0;
    double next_frame_s_ = 0.0;
    double publish_s_ = 0.0;
    bool waiting_ = false;
};

// Publishes a scene anew, of which the caller keeps one to be written while the loop may look at the other.
class TouchGame {
public:
    explicit TouchGame(TouchScene first) : scene(std::move(first)) {}
    void publish(const ServoSnapshot &seen, HapticCommand &command) {
        turn_ = 1 - turn_;
        published_[turn_] = scene;
        published_[turn_].state_time_s = seen.time_s;
        command.touch = &published_[turn_];
        ++command.touch_sequence;
    }
    TouchScene scene;

private:
    std::array<TouchScene, 2> published_;
    std::size_t turn_ = 0;
};

// Replaces the set of contacts.
inline void give_contacts(HapticCommand &command, const std::vector<ContactPlane> &planes) {
    command.contact_count = static_cast<int>(planes.size());
    std::copy(planes.begin(), planes.end(), command.contacts.begin());
    ++command.contacts_sequence;
}

} // namespace spidar::test
