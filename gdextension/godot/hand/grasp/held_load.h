// Wrench of a held body on the tool: weight and inertia at its center of mass, and loads that a
// game adds. Device frame, SI units.
//
// Contact of the held body with the world is not included: its shapes are parts of the tool, and
// the device renders them.
#pragma once

#include "core/base/types.h"
#include "device/contract/motion.h"

namespace spidar {

class HeldLoad {
public:
    struct Body {
        double mass_kg = 0.0;
        Vec3 gravity_m_s2{0.0}; // acceleration of gravity on it
        Vec3 center_m{0.0};     // center of mass, from the tool's P0
    };
    struct Terms {
        double gain = 1.0;        // factor on weight and inertia
        double max_force_n = 8.0; // the device's own limit
        bool with_weight = true;
        bool with_inertia = true;
    };

    // Restarts for a body that was just grasped.
    void reset() noexcept;
    // Starts a frame: removes the added loads.
    void clear() noexcept;
    // Adds a load of this frame, about P0. Ignored when not finite.
    void add(const Vec3 &force_n, const Vec3 &moment_nm) noexcept;
    // Called with each new pose, with or without a held body. center_m: grip center. since_s:
    // device time since the last pose; 0 is ignored.
    void follow(const Vec3 &center_m, double since_s) noexcept;
    // Force and moment about P0. own: weight and inertia. all: with the added loads.
    struct Pull {
        Wrench own;
        Wrench all;
        Vec3 weight_n{0.0}; // weight in `own`
    };
    [[nodiscard]] Pull pull(const Body &body, const Terms &terms) const noexcept;

private:
    Vec3 added_n_{0.0};
    Vec3 added_nm_{0.0};
    bool known_ = false;
    Vec3 center_m_{0.0};
    Vec3 velocity_m_s_{0.0}; // mean over the last two poses
    Vec3 acceleration_m_s2_{0.0};
    double since_s_ = 0.0;
    double age_s_ = 0.0;
};

} // namespace spidar
