// What the joints of a tool let through to the hand.
#include "device/contact/proxy/tool_proxy.h"

#include "device/contract/dof_lanes.h"

namespace spidar {

void ToolProxy::add_joints(const Move &pull, const Twist &velocity) noexcept {
    Move slides{};
    for (std::size_t dof = 0; dof < kDofCount; ++dof) {
        slides[dof] = lanes(velocity)[dof] * root_[dof];
    }
    const Move held = tie_.locked(pull);
    const Move slips = tie_.locked(slides);
    DofLanes sum = lanes(wrench_);
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] += root_[dof] * (held[dof] + bent_[dof] -
                                  settings_.damping_s * (slips[dof] - tie_.carried()[dof]));
    }
    wrench_ = of_lanes<Wrench>(sum);
}

void ToolProxy::add_force(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m,
                          const Vec3 &force_n, DofLanes &sum) const noexcept {
    const DofLanes acts = lanes(moves_along(part, jaws, pose_, point_m, force_n));
    Move scaled_by{};
    for (std::size_t dof = 0; dof < acts.size(); ++dof) {
        scaled_by[dof] = acts[dof] / root_[dof];
    }
    const Move felt = tie_.is_tied() ? tie_.left(scaled_by) : scaled_by;
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] += felt[dof] * root_[dof];
    }
}

} // namespace spidar
