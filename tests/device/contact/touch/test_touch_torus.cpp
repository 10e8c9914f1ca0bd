// A ball that slides round a torus of triangles, outside and in its hole, against the true torus: without a device's noise.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "support/touch_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kMiddle_m = 0.09;
constexpr double kTube_m = 0.02;
constexpr double kTool_m = 0.02;
constexpr double kDepth_m = 0.003;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

int edges_round(double radius_m, double edge_m) {
    return std::max(8, 4 * static_cast<int>(std::lround(0.25 * kTwoPi * radius_m / edge_m)));
}

// About the y axis, with corners at both rims; front outwards.
ShapeDescription torus(double edge_m) {
    const int around = edges_round(kMiddle_m + kTube_m, edge_m);
    const int of_tube = edges_round(kTube_m, edge_m);
    ShapeDescription mesh;
    mesh.kind = ShapeKind::mesh;
    for (int i = 0; i < around; ++i) {
        const double u = kTwoPi * i / around;
        for (int k = 0; k < of_tube; ++k) {
            const double v = kTwoPi * k / of_tube;
            const double out_m = kMiddle_m + kTube_m * std::cos(v);
            mesh.points_m.emplace_back(out_m * std::sin(u), kTube_m * std::sin(v),
                                       out_m * std::cos(u));
        }
    }
    const auto number = [&](int i, int k) {
        return static_cast<std::uint32_t>((i % around) * of_tube + k % of_tube);
    };
    for (int i = 0; i < around; ++i) {
        for (int k = 0; k < of_tube; ++k) {
            const std::uint32_t a = number(i, k);
            const std::uint32_t b = number(i + 1, k);
            const std::uint32_t c = number(i + 1, k + 1);
            const std::uint32_t d = number(i, k + 1);
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    }
    return mesh;
}

struct Slide {
    double mean_part = 0.0; // of the force and the true torus'
    double ripple_n = 0.0;  // along the true normal
    double sideways_n = 0.0;
    double deepest_m = 0.0;
    double stiffness_n_m = 0.0;
    double radius_m = 0.0; // of the tool's way
};

// Round a part of the torus, kDepth_m deep in the true one.
Slide slide(double edge_m, bool outside, double speed_m_s) {
    TouchRig rig;
    TouchScene touch;
    add_tool(touch, make_sphere(kTool_m));
    add(touch, cooked(torus(edge_m)));
    const double radius_m = outside ? kMiddle_m + kTube_m + kTool_m - kDepth_m
                                    : kMiddle_m - kTube_m - kTool_m + kDepth_m;
    Slide result;
    result.radius_m = radius_m;
    double least = 1e9;
    double most = -1e9;
    double sum = 0.0;
    int count = 0;
    const int settles = 200;
    const int ticks = settles + static_cast<int>(0.1 / speed_m_s / kTick_s); // 100 mm
    for (int i = 0; i < ticks; ++i) {
        const double angle = 0.353 + std::max(0, i - settles) * kTick_s * speed_m_s / radius_m;
        const Vec3 out(std::sin(angle), 0.0, std::cos(angle));
        const Vec3 normal = outside ? out : -out;
        const double raised_m = kDepth_m * std::max(0.0, 1.0 - i / 100.0);
        rig.motion.grip.pose.position_m = radius_m * out + raised_m * normal;
        rig.motion.velocity.linear_m_s =
            i < settles ? Vec3(0.0) : speed_m_s * Vec3(std::cos(angle), 0.0, -std::sin(angle));
        if (i % 16 == 0) {
            rig.give(touch);
        }
        const Vec3 force_n = rig.tick().force_n;
        const TouchReport told = rig.report();
        for (int p = 0; p < told.point_count; ++p) {
            result.deepest_m =
                std::max(result.deepest_m, -told.points[static_cast<std::size_t>(p)].gap_m);
        }
        result.stiffness_n_m = told.stiffness[0];
        if (i < settles) {
            continue;
        }
        const double push_n = glm::dot(force_n, normal);
        least = std::min(least, push_n);
        most = std::max(most, push_n);
        result.sideways_n = std::max(result.sideways_n, glm::length(force_n - push_n * normal));
        sum += push_n;
        ++count;
    }
    result.ripple_n = most - least;
    result.mean_part = sum / count / (result.stiffness_n_m * kDepth_m);
    return result;
}

} // namespace

TEST_CASE("touch: a ball that slides round a torus of triangles feels it as far as the triangles "
          "are one") {
    for (const double edge_m : {0.0015, 0.003, 0.006, 0.012}) {
        for (const bool outside : {true, false}) {
            for (const double speed_m_s : {0.1, 0.4}) {
                CAPTURE(edge_m);
                CAPTURE(outside);
                CAPTURE(speed_m_s);
                const Slide found = slide(edge_m, outside, speed_m_s);
                // Half the angle between two faces: how far a face leans from the torus. The tool turns round it by
                // more, in the cycle before it is looked at again.
                const double lean = std::numbers::pi / edges_round(kMiddle_m + kTube_m, edge_m);
                const double most_lean = lean + speed_m_s * kTick_s / found.radius_m;
                const double force_n = found.stiffness_n_m * kDepth_m;
                const double radius_m = outside ? kMiddle_m + kTube_m : kMiddle_m - kTube_m;
                const double faces_n = found.stiffness_n_m * radius_m * (1.0 - std::cos(lean));
                constexpr double kDamping_n_s_m = 2.0; // TouchScene's
                const double damper_n = 2.0 * kDamping_n_s_m * speed_m_s * std::sin(most_lean);
                MESSAGE("mean " << found.mean_part << ", ripple " << found.ripple_n
                                << " N (flat faces " << faces_n << ", their lean and the damper "
                                << damper_n << "), sideways " << found.sideways_n / force_n
                                << " (lean " << lean << ")");
                CHECK(std::abs(found.mean_part - 1.0) < 0.05);
                CHECK(found.ripple_n < faces_n + damper_n + 0.002);
                CHECK(found.sideways_n < (1.05 * most_lean + 0.002) * force_n);
                CHECK(found.deepest_m < 1e-5);
                if (edge_m <= 0.003 || (edge_m <= 0.006 && speed_m_s <= 0.1)) {
                    CHECK(found.ripple_n <= 0.05);
                }
            }
        }
    }
}
