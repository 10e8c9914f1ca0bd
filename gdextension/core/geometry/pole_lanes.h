// Two doubles computed side by side: lane 0 for pole 1, lane 1 for pole 2. The compiler's vector
// extension translates this code for every processor. With -ffp-contract=off, which forbids to fuse
// multiplications with additions, all processors compute the same bits.
#pragma once

#include <cmath>

#include "core/base/types.h"

namespace spidar {

using Lanes = double __attribute__((vector_size(16)));

[[nodiscard]] inline Lanes both(double value) noexcept {
    return Lanes{value, value};
}

[[nodiscard]] inline double sum_of(Lanes a) noexcept {
    return a[0] + a[1];
}

[[nodiscard]] inline Lanes square_root(Lanes a) noexcept {
#if __has_builtin(__builtin_ia32_sqrtpd) // by name: not every compiler merges two scalar roots
    return __builtin_ia32_sqrtpd(a);
#else
    return Lanes{std::sqrt(a[0]), std::sqrt(a[1])};
#endif
}

// One 3D vector per lane.
struct LaneVec {
    Lanes x{};
    Lanes y{};
    Lanes z{};
};

[[nodiscard]] inline LaneVec lanes_of(const Vec3 &one, const Vec3 &two) noexcept {
    return {Lanes{one.x, two.x}, Lanes{one.y, two.y}, Lanes{one.z, two.z}};
}

[[nodiscard]] inline Vec3 lane(const LaneVec &v, int pole) noexcept {
    return {v.x[pole], v.y[pole], v.z[pole]};
}

[[nodiscard]] inline LaneVec operator+(const LaneVec &a, const LaneVec &b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

[[nodiscard]] inline LaneVec operator-(const LaneVec &a, const LaneVec &b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[nodiscard]] inline LaneVec operator*(Lanes s, const LaneVec &a) noexcept {
    return {s * a.x, s * a.y, s * a.z};
}

[[nodiscard]] inline Lanes dot(const LaneVec &a, const LaneVec &b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

} // namespace spidar
