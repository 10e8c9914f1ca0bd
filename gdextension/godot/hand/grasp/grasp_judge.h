// Decides whether squeezing a body between the pads holds it. The body must be movable, its faces
// must oppose each other, and the squeeze and friction must suffice.
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
        double min_force_n = 0.1;  // smallest finger force that holds a body
        double weight_scale = 1.0; // factor on the weight that friction must carry
    };

    // Starts a new attempt: called for a new body and after the jaws have opened.
    void reset() noexcept;
    // finger_force_n: force on each pad. body: null for anything but a RigidBody3D, which gives
    // `wait`. Returns `refuse` at most once per attempt, when the jaws have rested; reason() then
    // returns why.
    [[nodiscard]] Verdict judge(const Pinch &pinch, godot::RigidBody3D *body, const Terms &terms,
                                double finger_force_n, double grasp_rate_rad_s, double delta_s);
    [[nodiscard]] const std::string &reason() const noexcept { return reason_; }

private:
    double settled_s_ = 0.0;
    bool told_ = false;
    std::string reason_;
};

} // namespace spidar
