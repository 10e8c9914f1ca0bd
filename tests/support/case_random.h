// Numbers for stress programs: one generator a case, so that each case replays alone, cheap enough for 10^9 of them, and
// the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <glm/gtc/quaternion.hpp>

#include "core/base/types.h"

namespace spidar::test {

class CaseRandom {
public:
    CaseRandom(std::uint64_t seed, std::uint64_t number)
        : state_(seed * 0x9e3779b97f4a7c15ULL ^ number * 0xd1342543de82ef95ULL) {}
    std::uint64_t bits() { // splitmix64
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    // Each factor of ten alike.
    double spread(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }
    double normal() { // sum of 12 uniforms
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += between(0.0, 1.0);
        }
        return sum;
    }
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
    Vec3 vector(double size) {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
    Mat3 rotation(double turn_rad) { // Rz Ry Rx
        const Vec3 a = vector(turn_rad);
        return glm::mat3_cast(glm::angleAxis(a.z, Vec3(0, 0, 1)) *
                              glm::angleAxis(a.y, Vec3(0, 1, 0)) *
                              glm::angleAxis(a.x, Vec3(1, 0, 0)));
    }
    // What no one should pass in: subnormals, infinities, NaN, the largest and smallest, any bits at all.
    double nasty() {
        constexpr double kValues[] = {0.0,
                                      -0.0,
                                      std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::denorm_min(),
                                      std::numeric_limits<double>::min(),
                                      std::numeric_limits<double>::max(),
                                      -std::numeric_limits<double>::max(),
                                      1e-300,
                                      1e300,
                                      -0.4};
        const std::size_t which = below(std::size(kValues) + 6);
        if (which < std::size(kValues)) {
            return kValues[which];
        }
        const std::uint64_t any = bits();
        double value = 0.0;
        std::memcpy(&value, &any, sizeof value);
        return value;
    }

private:
    std::uint64_t state_;
};

} // namespace spidar::test
