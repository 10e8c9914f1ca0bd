// What a held body pulls on the tool: weight and inertia at its centre of mass, and what a game adds. Device frame, SI.
//
// Contact of the held body with the world is not here: its shapes are parts of the tool, and the device renders them.
#pragma once

#include "core/base/types.h"
#include "device/contract/motion.h"

namespace spidar {

class HeldLoad {
public:
    struct Body {
        double mass_kg = 0.0;
        Vec3 gravity_m_s2{0.0}; // on it
        Vec3 center_m{0.0};     // of mass, from the tool's P0
    };
    struct Terms {
        double gain = 1.0;        // of weight and inertia alike
        double max_force_n = 8.0; // the device's own limit
        bool with_weight = true;
        bool with_inertia = true;
    };

    // A body has just been caught.
    void reset() noexcept;
    // A new frame: nothing else pulls yet.
    void clear() noexcept;
    // What else pulls in this frame, about P0; left out when it is not finite.
    void add(const Vec3 &force_n, const Vec3 &moment_nm) noexcept;
    // Each new pose, whether a body is held or not. center_m: the grip's centre; since_s: device time since the pose
    // before; 0 is ignored.
    void follow(const Vec3 &center_m, double since_s) noexcept;
    // Force and moment about P0: weight and inertia alone, and with what was added.
    struct Pull {
        Wrench own;
        Wrench all;
        Vec3 weight_n{0.0}; // of own
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
