#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/finite.h"

using namespace spidar;

TEST_CASE("finite: one NaN or infinity anywhere inside a value is found") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(all_finite(0.0));
    CHECK_FALSE(all_finite(nan));
    CHECK_FALSE(all_finite(-infinity));
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 v(1.0);
        CHECK(all_finite(v));
        v[axis] = infinity;
        CHECK_FALSE(all_finite(v));
        Mat3 m(1.0);
        CHECK(all_finite(m));
        m[axis] = v;
        CHECK_FALSE(all_finite(m));
        StringVectors motors{};
        CHECK(all_finite(motors));
        motors.back() = v;
        CHECK_FALSE(all_finite(motors));
        CHECK_FALSE(all_finite(Wrench{v, Vec3(0.0), 0.0}));
        CHECK_FALSE(all_finite(Twist{Vec3(0.0), v, 0.0}));
    }
    CHECK_FALSE(all_finite(Wrench{Vec3(0.0), Vec3(0.0), nan}));
    CHECK(all_finite(Twist{}));
    const std::vector<double> largest(3, std::numeric_limits<double>::max());
    CHECK(all_finite(largest)); // their sum is infinite, none of them is
    CHECK(all_finite(largest, 1.0, Vec3(2.0)));
    CHECK_FALSE(all_finite(largest, 1.0, Vec3(nan)));
}
