// The lines that show a shape lie on it, and only what is near is drawn of large ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "device/contact/shapes/shape_outline.h"
#include "support/shape_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kAnywhere_m = 10.0; // a ball that holds every shape of these tests

std::vector<Vec3> outline(const CookedShape &shape, const Vec3 &ball_m = Vec3(0.0),
                          double radius_m = kAnywhere_m) {
    std::vector<Vec3> lines;
    add_outline(shape, ball_m, radius_m, lines);
    CHECK(lines.size() % 2 == 0);
    CHECK(lines.size() <= 2 * kMostOutlineLines);
    return lines;
}

// Largest distance of the lines' ends from a surface whose distance `from` tells.
template <class From>
double farthest(const std::vector<Vec3> &lines, From &&from) {
    double most = 0.0;
    for (const Vec3 &end : lines) {
        most = std::max(most, std::abs(from(end)));
    }
    return most;
}

} // namespace

TEST_CASE("outline: the lines of round shapes lie on them") {
    constexpr double kRadius_m = 0.02;
    constexpr double kHalf_m = 0.05;
    const auto ball = outline(*round_shape(ShapeKind::sphere, kRadius_m));
    CHECK(ball.size() == 2 * 3 * 32);
    CHECK(farthest(ball, [](const Vec3 &x) { return glm::length(x) - kRadius_m; }) < 1e-12);
    const auto capsule = outline(*round_shape(ShapeKind::capsule, kRadius_m, kHalf_m));
    CHECK(farthest(capsule, [=](const Vec3 &x) {
              const double y = std::clamp(x.y, -kHalf_m, kHalf_m);
              return glm::length(x - Vec3(0.0, y, 0.0)) - kRadius_m;
          }) < 1e-12);
    CHECK(farthest(capsule, [=](const Vec3 &x) { return x.y; }) ==
          doctest::Approx(kHalf_m + kRadius_m));
    const auto cylinder = outline(*round_shape(ShapeKind::cylinder, kRadius_m, kHalf_m));
    CHECK(farthest(cylinder, [](const Vec3 &x) { return std::hypot(x.x, x.z) - kRadius_m; }) <
          1e-12);
    CHECK(farthest(cylinder, [](const Vec3 &x) { return std::abs(x.y) - kHalf_m; }) < 1e-12);
}

TEST_CASE("outline: a box and its hull have the twelve edges, each once") {
    const Vec3 half(0.01, 0.02, 0.03);
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
        corners.push_back(half * Vec3(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0));
    }
    for (const ShapePtr &shape : {box(half), hull(corners)}) {
        const std::vector<Vec3> lines = outline(*shape);
        REQUIRE(lines.size() == 24);
        double length = 0.0;
        for (std::size_t i = 0; i < lines.size(); i += 2) {
            const Vec3 by = glm::abs(lines[i] - lines[i + 1]);
            CHECK(std::max({by.x, by.y, by.z}) == doctest::Approx(by.x + by.y + by.z));
            length += by.x + by.y + by.z;
            for (std::size_t k = 0; k < i; k += 2) { // no edge twice, either way round
                CHECK(glm::distance(lines[i] + lines[i + 1], lines[k] + lines[k + 1]) > 1e-6);
            }
        }
        CHECK(length == doctest::Approx(4.0 * 2.0 * (half.x + half.y + half.z)));
    }
}

TEST_CASE("outline: of a mesh and a height map the edges near the ball come, once each") {
    constexpr int kCells = 40;
    constexpr double kCell_m = 0.01;
    const ShapeDescription mesh = field(kCells, kCell_m, [](double, double) { return 0.0; });
    for (const ShapeDescription &shape : {mesh, as_height_map(mesh, kCells, kCell_m)}) {
        const ShapePtr made = cooked(shape);
        // Far above it: nothing.
        CHECK(outline(*made, Vec3(0.0, 0.1, 0.0), 0.05).empty());
        const std::vector<Vec3> lines = outline(*made, Vec3(0.001, 0.0, 0.002), 0.025);
        CHECK(lines.size() > 20);
        for (std::size_t i = 0; i < lines.size(); i += 2) {
            CHECK(glm::length(lines[i]) < 0.025 + 3.0 * kCell_m);
            for (std::size_t k = 0; k < i; k += 2) {
                CHECK(glm::distance(lines[i] + lines[i + 1], lines[k] + lines[k + 1]) > 1e-6);
            }
        }
    }
    // Where thousands are near, the rest is left out.
    const ShapePtr fine = cooked(field(80, 0.001, [](double, double) { return 0.0; }));
    CHECK(outline(*fine).size() == 2 * kMostOutlineLines);
}

TEST_CASE("outline: a half space is a grid over the ball, in its plane") {
    const Vec3 normal = glm::normalize(Vec3(0.2, 1.0, -0.4));
    const Vec3 ball_m(3.0, -1.0, 5.0);
    const std::vector<Vec3> lines = outline(*half_space(normal, 0.03), ball_m, 0.1);
    CHECK(lines.size() == 2 * 2 * 9);
    CHECK(farthest(lines, [&](const Vec3 &x) { return glm::dot(normal, x) - 0.03; }) < 1e-12);
    const Vec3 foot = ball_m - (glm::dot(normal, ball_m) - 0.03) * normal;
    CHECK(farthest(lines, [&](const Vec3 &x) { return glm::distance(x, foot); }) ==
          doctest::Approx(0.1 * std::sqrt(2.0)));
}
