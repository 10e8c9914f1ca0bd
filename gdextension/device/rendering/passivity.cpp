#include "device/rendering/passivity.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// Slow part (N, N m) that counts as zero, since nobody feels it end.
constexpr double kNoForce = 1e-5;
// Stored energy that counts as zero: a millimeter against that force.
constexpr double kNoEnergy_j = 1e-8;

} // namespace

void EnergyObserver::update(const Displacement &moved) noexcept {
    const DofLanes move = lanes(moved);
    moving_ = move != DofLanes{};
    for (std::size_t i = 0; i < move.size(); ++i) {
        injected_j_[i] += held_[i] * move[i];
    }
}

void EnergyObserver::hold(const Wrench &wrench) noexcept {
    held_ = lanes(wrench);
}

void PassivityController::configure(const DofGains &most_damping) noexcept {
    *this = PassivityController();
    most_ = most_damping;
}

void PassivityController::reset() noexcept {
    slow_ = {};
    changing_ = {};
    store_j_ = {};
    at_rest_ = true;
}

Wrench PassivityController::correct(const Wrench &asked, const Displacement &moved,
                                    const Twist &velocity, double dt_s) noexcept {
    const DofLanes force = lanes(asked);
    if (at_rest_ && force == DofLanes{}) {
        return asked; // nothing held, nothing stored: motion alone changes nothing
    }
    const DofLanes move = lanes(moved);
    const DofLanes speed = lanes(velocity);
    const double blend = dt_s / (dt_s + kSlow_s);
    const double keep = 1.0 - dt_s / (dt_s + kMemory_s);
    DofLanes out = force;
    bool moving = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
        store_j_[i] = std::clamp(keep * store_j_[i] - changing_[i] * move[i], -kStore_j, kStore_j);
        slow_[i] += blend * (force[i] - slow_[i]);
        if (store_j_[i] < 0.0 && most_[i] > 0.0) {
            const double full = speed[i] * speed[i] * dt_s;
            // The energy to take back in this cycle, as far as the cap allows.
            const double damping = -store_j_[i] < most_[i] * full ? -store_j_[i] / full : most_[i];
            out[i] -= damping * speed[i];
        }
        changing_[i] = out[i] - slow_[i];
        moving = moving || force[i] != 0.0 || std::abs(slow_[i]) > kNoForce ||
                 std::abs(store_j_[i]) > kNoEnergy_j;
    }
    at_rest_ = false;
    if (!moving) {
        reset();
    }
    return of_lanes<Wrench>(out);
}

} // namespace spidar
