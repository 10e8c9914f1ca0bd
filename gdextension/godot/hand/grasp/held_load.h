// Computes the wrench of a held body on the tool: weight and inertia at the center of mass, and
// loads that a game adds. Device frame, SI units.
//
// Contact of the held body with the world is not included: the body's shapes are parts of the tool,
// and the servo loop renders them.
#pragma once

#include "core/base/types.h"
#include "device/contract/motion.h"

namespace spidar {

class HeldLoad {
public:
    struct Body {
        double mass_kg = 0.0;
        Vec3 gravity_m_s2{0.0}; // acceleration of gravity at the body
        Vec3 center_m{0.0};     // from the tool's P0 to the center of mass
    };
    struct Terms {
        double gain = 1.0;        // factor on weight and inertia
        double max_force_n = 8.0; // SpidarGConfig.max_force
        bool with_weight = true;
        bool with_inertia = true;
    };

    // Restarts for a body that was just grasped.
    void reset() noexcept;
    // Removes the added loads. Called at the start of each tick.
    void clear() noexcept;
    // Adds a load for this tick, about P0. Ignored when not finite.
    void add(const Vec3 &force_n, const Vec3 &moment_nm) noexcept;
    // Called with each new pose, with or without a held body. center_m: center of the grip.
    // since_s: device time since the last pose; the call is ignored if it is 0.
    void follow(const Vec3 &center_m, double since_s) noexcept;
    // Wrenches about P0, with forces of at most max_force_n.
    struct Pull {
        Wrench own;         // weight and inertia
        Wrench all;         // the same and the added loads
        Vec3 weight_n{0.0}; // the weight alone, unlimited
    };
    [[nodiscard]] Pull pull(const Body &body, const Terms &terms) const noexcept;

private:
    Vec3 added_n_{0.0};
    Vec3 added_nm_{0.0};
    bool known_ = false;
    Vec3 center_m_{0.0};
    Vec3 velocity_m_s_{0.0}; // mean between the last two poses
    Vec3 acceleration_m_s2_{0.0};
    double since_s_ = 0.0;
    double age_s_ = 0.0;
};

} // namespace spidar
