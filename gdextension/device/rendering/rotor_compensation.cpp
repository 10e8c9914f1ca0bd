#include "device/rendering/rotor_compensation.h"

#include <algorithm>

namespace spidar {

StringArray rotor_compensation(const RenderSettings &settings, const WrenchMatrix &matrix,
                               const Twist &twist) noexcept {
    // The paper's seventh rate is half of grasp_rate, since its g is twice the torque.
    const StringArray winding_m_s = apply_transposed(
        matrix, {twist.linear_m_s.x, twist.linear_m_s.y, twist.linear_m_s.z, twist.angular_rad_s.x,
                 twist.angular_rad_s.y, twist.angular_rad_s.z, 0.5 * twist.grasp_rate_rad_s});
    StringArray extra_n{};
    for (std::size_t i = 0; i < extra_n.size(); ++i) {
        extra_n[i] = settings.compensated_friction_n *
                         std::clamp(winding_m_s[i] / kFrictionBand_m_s, -1.0, 1.0) +
                     settings.compensated_viscous_n_s_m * winding_m_s[i];
    }
    return extra_n;
}

} // namespace spidar
