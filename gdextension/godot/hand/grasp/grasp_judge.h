// Decides whether the squeeze on a body between the pads holds it: opposing faces and a friction check.
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
        double pad_friction = 1.0; // on a body that says nothing of its own
        double min_force_n = 0.1;  // least finger force that holds anything, however light
        double weight_scale = 1.0; // of the weight that friction has to carry
    };

    // A new body, or the jaws have opened: the next squeeze is a new attempt.
    void reset() noexcept;
    // finger_force_n: on each pad. body: null for what is no RigidBody3D. Refuses once an attempt: reason() tells why.
    [[nodiscard]] Verdict judge(const Pinch &pinch, godot::RigidBody3D *body, const Terms &terms,
                                double finger_force_n, double grasp_rate_rad_s, double delta_s);
    [[nodiscard]] const std::string &reason() const noexcept { return reason_; }

private:
    double settled_s_ = 0.0;
    bool told_ = false;
    std::string reason_;
};

} // namespace spidar
