// Decides whether squeezing a body between the pads holds it: the faces must oppose each other and
// friction must suffice.
#pragma once

#include <string>

#include "godot/hand/grasp/pinch.h"

namespace godot {
class RigidBody3D;
}

namespace spidar {

class GraspJudge {
public:
    enum class Verdict { wait, hold, refuse };

    struct Terms {
        double pad_friction = 1.0; // for bodies without a friction of their own
        double min_force_n = 0.1;  // smallest finger force that holds anything
        double weight_scale = 1.0; // factor on the weight that friction must carry
    };

    // Starts a new attempt, after a new body or when the jaws have opened.
    void reset() noexcept;
    // finger_force_n: force on each pad. body: null for anything but a RigidBody3D. Refuses once
    // per attempt; reason() then returns why.
    [[nodiscard]] Verdict judge(const Pinch &pinch, godot::RigidBody3D *body, const Terms &terms,
                                double finger_force_n, double grasp_rate_rad_s, double delta_s);
    [[nodiscard]] const std::string &reason() const noexcept { return reason_; }

private:
    double settled_s_ = 0.0;
    bool told_ = false;
    std::string reason_;
};

} // namespace spidar
