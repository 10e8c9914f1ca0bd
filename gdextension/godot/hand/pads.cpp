#include "godot/hand/pads.h"

#include "godot/hand/grasp/pinch.h"

namespace spidar {

namespace {

// Rotation from the disc's axis Y to the jaws' axis, the grip's x.
const Mat3 kDiscAlongX(Vec3(0.0, -1.0, 0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0));

} // namespace

void Pads::fit(const Jaws &jaws) {
    if (jaws.open_m == open_m_) {
        return;
    }
    open_m_ = jaws.open_m;
    const double edge_m = 0.5 * pad_thickness_m(jaws);
    shape_ = make_pad(pad_radius_m(jaws), edge_m, edge_m).tool;
}

Tool Pads::tool(const Jaws &jaws) const noexcept {
    Tool tool;
    tool.jaws = jaws;
    for (std::size_t side = 0; side < 2; ++side) {
        ToolPart &part = tool.parts[side];
        part.shape = shape_.get();
        part.mount = side == 0 ? ToolMount::jaw_minus : ToolMount::jaw_plus;
        const double outward_m = (side == 0 ? -0.5 : 0.5) * pad_thickness_m(jaws);
        part.at = {Vec3(outward_m, 0.0, 0.0), kDiscAlongX};
        part.id = kPadIds[side];
        part.groups = kPadGroup;
    }
    tool.count = 2;
    return tool;
}

Placement Pads::face(int side, const Jaws &jaws, const ToolPose &pose) noexcept {
    const double outward = side == 0 ? -1.0 : 1.0;
    // Side 0 faces the other way: half a turn about y.
    const Mat3 turn =
        side == 0 ? Mat3(-pose.rotation[0], pose.rotation[1], -pose.rotation[2]) : pose.rotation;
    const double along_m = 0.5 * outward * jaws.gap_m(pose.grasp_rad);
    return {pose.position_m + along_m * pose.rotation[0], turn};
}

} // namespace spidar
