// Sums of wrenches over all seven degrees of freedom.
#pragma once

#include "core/base/types.h"

namespace spidar {

[[nodiscard]] inline Wrench operator+(const Wrench &a, const Wrench &b) noexcept {
    return {a.force_n + b.force_n, a.moment_nm + b.moment_nm,
            a.grasp_torque_nm + b.grasp_torque_nm};
}
[[nodiscard]] inline Wrench operator*(double factor, const Wrench &wrench) noexcept {
    return {factor * wrench.force_n, factor * wrench.moment_nm, factor * wrench.grasp_torque_nm};
}

} // namespace spidar
