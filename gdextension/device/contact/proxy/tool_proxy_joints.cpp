// What the joints of a tool let through to the hand.
#include "device/contact/proxy/tool_proxy.h"

#include <cmath>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

double size_of(const std::array<double, 8> &move) noexcept {
    double sum = 0.0;
    for (const double lane : move) {
        sum += lane * lane;
    }
    return std::sqrt(sum);
}

} // namespace

void ToolProxy::add_joints(const Move &pull, const Move &pushed, const Twist &velocity) noexcept {
    // Springs and contacts together hold the proxy where it is. A proxy that is still on its way there is not yet pulled so far.
    const double most = kMostPush * (size_of(pull) + size_of(pushed));
    const double bent = size_of(bent_);
    const double part = bent > most ? most / bent : 1.0;
    Move slides{};
    for (std::size_t dof = 0; dof < kDofCount; ++dof) {
        slides[dof] = lanes(velocity)[dof] * root_[dof];
    }
    const Move held = tie_.locked(pull);
    const Move slips = tie_.locked(slides);
    DofLanes sum = lanes(wrench_);
    for (std::size_t dof = 0; dof < sum.size(); ++dof) {
        sum[dof] += root_[dof] * (held[dof] + part * bent_[dof] -
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
