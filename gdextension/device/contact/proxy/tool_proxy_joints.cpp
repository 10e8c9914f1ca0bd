// Forces of a tool's joints on the hand.
#include "device/contact/proxy/tool_proxy.h"

#include <cmath>

#include "device/contract/dof_lanes.h"

namespace spidar {

void ToolProxy::add_joints(const Move &pull, const Move &pushed, const Twist &velocity) noexcept {
    // Springs and contacts together hold the proxy in place. A proxy that is still moving there is
    // pulled less.
    const double most = kMostPush * (std::sqrt(dot(pull, pull)) + std::sqrt(dot(pushed, pushed)));
    const double bent = std::sqrt(dot(bent_, bent_));
    const double part = bent > most ? most / bent : 1.0;
    const Move held = tie_.locked(pull);
    const Move slips = tie_.locked(times(lanes(velocity), root_));
    DofLanes sum = lanes(wrench_);
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] += root_[dof] * (held[dof] + part * bent_[dof] -
                                  settings_.damping_s * (slips[dof] - tie_.carried()[dof]));
    }
    wrench_ = of_lanes<Wrench>(sum);
}

void ToolProxy::add_force(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m,
                          const Vec3 &force_n, DofLanes &sum) const noexcept {
    const Move acts = over(lanes(moves_along(part, jaws, pose_, point_m, force_n)), root_);
    const Move felt = tie_.is_tied() ? tie_.left(acts) : acts;
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] += felt[dof] * root_[dof];
    }
}

} // namespace spidar
