#include "device/tracking/fingers.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// Rate of the approach: closed within 0.2 s of a button press.
constexpr double kPace_1_s = 30.0;
// Distance and rate below which the fingers have arrived, far below any sensor's resolution.
constexpr double kArrived_rad = 1e-9;
constexpr double kArrived_rad_s = 1e-7;

// Returns the share clamped to 0..1; 0 for NaN.
double clamped_share(double share) noexcept {
    return share > 0.0 ? std::min(share, 1.0) : 0.0;
}

} // namespace

void Fingers::configure(const FingerSettings &settings, GripKind kind) noexcept {
    *this = Fingers();
    settings_ = settings;
    motion_.given = kind == GripKind::rigid;
}

double Fingers::share_of(const DeviceReading &reading) const noexcept {
    double share = (reading.buttons & settings_.button_mask) != 0 ? 1.0 : 0.0;
    if (settings_.sensor >= 0) {
        const double value = reading.sensors[static_cast<std::size_t>(settings_.sensor)];
        share = std::max(share, clamped_share((value - settings_.sensor_open) /
                                              (settings_.sensor_closed - settings_.sensor_open)));
    }
    return share;
}

double Fingers::share_of(const HapticCommand &command) const noexcept {
    return settings_.by_game ? clamped_share(command.grasp_share) : 0.0;
}

double Fingers::target_rad() const noexcept {
    return motion_.given ? settings_.closed_rad * std::max(device_share_, game_share_) : 0.0;
}

void Fingers::take(const DeviceReading &reading) noexcept {
    device_share_ = share_of(reading);
}

void Fingers::take(const HapticCommand &command) noexcept {
    game_share_ = share_of(command);
}

bool Fingers::has_seen(const DeviceReading &reading, const HapticCommand &command) const noexcept {
    return !motion_.given ||
           (share_of(reading) == device_share_ && share_of(command) == game_share_);
}

// Critically damped and solved exactly: no time step causes overshoot.
void Fingers::advance(double dt_s) noexcept {
    if (at_rest()) {
        return;
    }
    const double target = target_rad();
    const double off_rad = motion_.angle_rad - target;
    const double both = motion_.rate_rad_s + kPace_1_s * off_rad;
    const double decay = std::exp(-kPace_1_s * dt_s);
    motion_.angle_rad = target + (off_rad + both * dt_s) * decay;
    motion_.rate_rad_s = (motion_.rate_rad_s - kPace_1_s * both * dt_s) * decay;
    if (std::abs(motion_.angle_rad - target) < kArrived_rad &&
        std::abs(motion_.rate_rad_s) < kArrived_rad_s) {
        motion_.angle_rad = target;
        motion_.rate_rad_s = 0.0;
    }
}

} // namespace spidar
