#include "godot/hand/grasp/partner_ties.h"

#include <algorithm>
#include <utility>

#include "godot/base/type_conversions.h"
#include "godot/hand/grasp/joint_frames.h"

namespace spidar {

namespace {

// Stiffness of a tie relative to the springs between a device and its proxy. Stiff enough to feel
// the other hand, and soft enough that a reply one tick late, which is multiplied by 2/3 on each of
// its two ways, dies out.
constexpr double kPartOfOwn = 2.0;
// Time after which a tie is removed: its spring has faded by then.
constexpr double kLeaves_s = 0.2;

JointAxis spring(double stiffness) {
    JointAxis axis = JointAxis::free();
    axis.stiffness = stiffness;
    return axis;
}

} // namespace

std::vector<ToolJoint> PartnerTies::now(const std::vector<SharedHold> &others,
                                        const DofGains &stiffness,
                                        const godot::Transform3D &in_grip, const WorldFrame &frame,
                                        double tick_s) {
    for (Tie &tie : ties_) {
        tie.left_s -= tick_s;
        tie.joint.axes.fill(spring(0.0));
        tie.joint.velocity_m_s = Vec3(0.0);
        tie.joint.angular_rad_s = Vec3(0.0);
    }
    for (const SharedHold &other : others) {
        ToolJoint joint = joint_between(other.hand, other.body, in_grip, frame);
        joint.velocity_m_s = frame.velocity_to_device(to_core(other.velocity));
        joint.angular_rad_s = frame.turn_to_device(to_core(other.turning));
        for (std::size_t axis = 0; axis < joint.axes.size(); ++axis) {
            joint.axes[axis] = spring(kPartOfOwn * stiffness[axis]);
        }
        const auto known =
            std::ranges::find(ties_, joint.id, [](const Tie &tie) { return tie.joint.id; });
        if (known != ties_.end()) {
            *known = {joint, kLeaves_s};
        } else {
            ties_.push_back({joint, kLeaves_s});
        }
    }
    std::erase_if(ties_, [](const Tie &tie) { return !(tie.left_s > 0.0); });
    std::vector<ToolJoint> joints;
    for (const Tie &tie : ties_) {
        joints.push_back(tie.joint);
    }
    return joints;
}

} // namespace spidar
