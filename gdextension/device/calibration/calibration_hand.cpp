#include "device/calibration/calibration_hand.h"

#include <cmath>

namespace spidar {

namespace {

// Share of the reach that the hand uses: poses near its border are nearly singular and are left out
// of a fit.
constexpr double kFreeShare = 0.85;
constexpr double kPlaceShare = 0.5;
// Turns of a comfortable wrist and half the range of the grasp (unit: rad).
constexpr double kFreeTurn_rad = 0.6;
constexpr double kFreeGrasp_rad = 0.55;
// Below the hand's own speed limits, so that it can follow.
constexpr double kRates_rad_s[7] = {2.3, 1.7, 2.9, 3.1, 3.7, 2.1, 2.6};

} // namespace

HandTarget calibration_hand(const PlantSettings &plant, HandScript script, int place,
                            double time_s) noexcept {
    HandTarget target;
    const Vec3 reach = clamped_to_reach(plant, Vec3(1e3));
    if (script == HandScript::place) {
        const auto side = [&](int bit) { return ((place >> bit) & 1) != 0 ? 1.0 : -1.0; };
        target.position_m = kPlaceShare * Vec3(side(0), side(1), side(2)) * reach;
    } else if (script == HandScript::free_motion) {
        const auto wave = [&](int i) { return std::sin(kRates_rad_s[i] * time_s); };
        target.position_m = kFreeShare * Vec3(wave(0), wave(1), wave(2)) * reach;
        const Quat turn = glm::angleAxis(kFreeTurn_rad * wave(5), Vec3(0, 0, 1)) *
                          glm::angleAxis(kFreeTurn_rad * wave(4), Vec3(0, 1, 0)) *
                          glm::angleAxis(kFreeTurn_rad * wave(3), Vec3(1, 0, 0));
        target.rotation = glm::mat3_cast(turn);
        target.grasp_angle_rad =
            plant.grip.kind == GripKind::crossed ? kFreeGrasp_rad * wave(6) : 0.0;
    }
    return target;
}

} // namespace spidar
