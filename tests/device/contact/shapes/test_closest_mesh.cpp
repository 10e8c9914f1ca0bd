#include "device/contact/shapes/shape_test_support.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kMargin = 4e-3;

double wavy(double x, double z) {
    return 0.01 * std::sin(20.0 * x) * std::cos(17.0 * z);
}

double rough(double x, double z) { // corners of every kind, 5 mm apart
    return 0.004 * std::sin(900.0 * x) * std::sin(1100.0 * z + 1.0) + 0.02 * x;
}

std::vector<ToolPtr> all_tools() {
    CaseRandom random(21, 0);
    return {tool(make_sphere(0.012)),
            tool(make_pad(0.012, 0.003, 0.003)),
            tool(make_pad(0.012, 0.003, 0.001)),
            tool(make_tool(*box({0.02, 0.005, 0.01}))),
            tool(make_tool(*round_shape(ShapeKind::capsule, 0.004, 0.01))),
            tool(make_tool(*hull(random_points(random, 20, 0.01))))};
}

} // namespace

TEST_CASE("mesh contacts: as every triangle by itself, for every tool, on meshes and height maps") {
    CaseRandom random(22, 0);
    const int cells = 24;
    const double cell = 0.005;
    const ShapeDescription smooth = field(cells, cell, wavy);
    const ShapeDescription jagged = field(cells, cell, rough);
    ShapeDescription open = jagged;
    open.two_sided = true;
    const std::vector<ShapePtr> shapes{cooked(smooth),
                                       cooked(jagged),
                                       cooked(open),
                                       cooked(as_height_map(smooth, cells, cell)),
                                       cooked(as_height_map(jagged, cells, cell)),
                                       cooked(box_mesh({0.02, 0.01, 0.03}))};
    int near = 0;
    for (const ToolPtr &tool : all_tools()) {
        for (const ShapePtr &shape : shapes) {
            for (int i = 0; i < 60; ++i) {
                const Placement shape_at{random.vector(0.1), random.rotation(3.0)};
                Placement inside;
                inside.origin_m = random.vector(0.05);
                inside.origin_m.y = random.between(0.0, 0.03);
                inside.rotation = random.rotation(3.0);
                const Placement tool_at = shape_at * inside;
                const ClosestPoints found = ask(*tool, tool_at, *shape, shape_at, kMargin);
                check_points(found, kMargin);
                const double exact = brute_gap(*tool, tool_at, *shape, shape_at);
                if (std::isnan(exact)) {
                    continue; // under the surface: what it would meet there is no contact of its front
                }
                if (exact > kMargin) {
                    CHECK(found.count == 0);
                } else if (exact > -tool->skin_m() + 1e-7) {
                    ++near;
                    CHECK(std::abs(smallest_gap(found) - exact) < 2e-8);
                } else if (exact <= -tool->skin_m()) { // the core meets a triangle: recovery
                    REQUIRE(found.count > 0);
                    CHECK(found.points[0].core_inside);
                }
            }
        }
    }
    CHECK(near > 300);
}

TEST_CASE("mesh contacts: the remembered triangles give what a fresh look gives") {
    CaseRandom random(23, 0);
    const ShapePtr shape = cooked(field(40, 0.003, rough));
    for (const ToolPtr &tool : all_tools()) {
        auto memory = std::make_unique<PairMemory>();
        Placement at{{0.0, 0.02, 0.0}, Mat3(1.0)};
        for (int i = 0; i < 400; ++i) {
            at.origin_m += random.vector(5e-4);
            at.origin_m.y = std::fmin(std::fmax(at.origin_m.y, 0.012), 0.022);
            at.rotation = at.rotation * random.rotation(0.03);
            ClosestPoints found;
            REQUIRE(closest_points(*tool, at, *shape, {}, kMargin, *memory, found) == Status::ok);
            const ClosestPoints fresh = ask(*tool, at, *shape, {}, kMargin);
            REQUIRE(found.count == fresh.count);
            if (found.count > 0) {
                CHECK(std::abs(smallest_gap(found) - smallest_gap(fresh)) < 1e-9);
            }
        }
    }
}

TEST_CASE("mesh contacts: the seams of a flat floor are not felt") {
    CaseRandom random(24, 0);
    const ShapePtr floor = cooked(field(40, 0.005, [](double, double) { return 0.0; }));
    const ToolPtr sphere = tool(make_sphere(0.012));
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    for (int i = 0; i < 500; ++i) {
        Vec3 place = random.vector(0.06);
        if (i % 5 == 0) { // exactly over a corner or an edge
            place = {0.005 * std::floor(place.x / 0.005), 0.0,
                     i % 10 == 0 ? 0.005 * std::floor(place.z / 0.005) : place.z};
        }
        place.y = 0.0125;
        const ClosestPoints ball = ask(*sphere, {place, Mat3(1.0)}, *floor, {}, kMargin);
        REQUIRE(ball.count == 1);
        CHECK(std::abs(ball.points[0].gap_m - 0.0005) < 1e-12);
        CHECK(glm::length(ball.points[0].normal - Vec3(0, 1, 0)) < 1e-9);
        place.y = 0.0035;
        const Mat3 turn = random.rotation(0.03);
        const ClosestPoints disc = ask(*pad, {place, turn}, *floor, {}, kMargin);
        CHECK(disc.count == kPointsPerFace);
        for (int k = 0; k < disc.count; ++k) {
            CHECK(glm::length(disc.points[static_cast<std::size_t>(k)].normal - Vec3(0, 1, 0)) <
                  1e-9);
        }
        const double lean = std::sqrt(1.0 - turn[1].y * turn[1].y);
        CHECK(std::abs(disc.points[0].gap_m - (0.0005 - 0.009 * lean)) < 1e-9);
    }
}

TEST_CASE("mesh contacts: floor and wall of one corner both push") {
    ShapeDescription corner;
    corner.kind = ShapeKind::mesh;
    corner.points_m = {{0, 0, -0.1},  {0, 0, 0.1},    {0.1, 0, -0.1},
                       {0.1, 0, 0.1}, {0, 0.1, -0.1}, {0, 0.1, 0.1}};
    corner.indices = {0, 1, 2, 2, 1, 3, 0, 4, 1, 1, 4, 5}; // floor up, wall towards +X
    const ShapePtr shape = cooked(corner);
    const ToolPtr sphere = tool(make_sphere(0.012));
    const ClosestPoints found =
        ask(*sphere, {{0.0125, 0.0115, 0.013}, Mat3(1.0)}, *shape, {}, kMargin);
    REQUIRE(found.count == 2);
    CHECK(glm::length(found.points[0].normal - Vec3(0, 1, 0)) < 1e-12);
    CHECK(std::abs(found.points[0].gap_m + 0.0005) < 1e-12);
    CHECK(glm::length(found.points[1].normal - Vec3(1, 0, 0)) < 1e-12);
    CHECK(std::abs(found.points[1].gap_m - 0.0005) < 1e-12);
}

TEST_CASE("mesh contacts: a ball rolls round the edge of a block, its normal turning with it") {
    const ShapePtr block = cooked(box_mesh({0.05, 0.05, 0.05}));
    const ToolPtr sphere = tool(make_sphere(0.01));
    for (int degree = 0; degree <= 90; degree += 5) {
        const double angle = degree * 3.14159265358979323846 / 180.0;
        const Vec3 normal(std::sin(angle), std::cos(angle), 0.0);
        const Vec3 place = Vec3(0.05, 0.05, 0.013) + 0.011 * normal;
        const ClosestPoints found = ask(*sphere, {place, Mat3(1.0)}, *block, {}, kMargin);
        REQUIRE(found.count == 1);
        CHECK(glm::length(found.points[0].normal - normal) < 1e-9);
        CHECK(std::abs(found.points[0].gap_m - 0.001) < 1e-12);
    }
}

TEST_CASE("mesh contacts: one-sided triangles let pass from behind, two-sided ones do not") {
    ShapeDescription sheet = field(4, 0.02, [](double, double) { return 0.0; });
    const ShapePtr one = cooked(sheet);
    sheet.two_sided = true;
    const ShapePtr both = cooked(sheet);
    for (const ToolPtr &tool : all_tools()) {
        const double reach = tool->reach_m();
        const Placement below{{0.003, -reach - 1e-4, 0.002}, Mat3(1.0)};
        CHECK(ask(*tool, below, *one, {}, 0.01).count == 0);
        const ClosestPoints found = ask(*tool, below, *both, {}, 0.03);
        REQUIRE(found.count > 0);
        CHECK(glm::length(found.points[0].normal - Vec3(0, -1, 0)) < 1e-9);
        CHECK(ask(*tool, {{0.003, reach + 1e-4, 0.002}, Mat3(1.0)}, *one, {}, 0.03).count > 0);
    }
}

TEST_CASE("mesh contacts: a flat bar on a narrow block of triangles stands on the block's edges") {
    const ShapePtr block = cooked(box_mesh({0.01, 0.05, 0.05}));
    const ToolPtr bar = tool(make_tool(*box({0.1, 0.01, 0.01})));
    const ClosestPoints found = ask(*bar, {{0.08, 0.061, 0}, Mat3(1.0)}, *block, {}, 0.003);
    check_stands_on_edges(found, 0.01, 0.001, 1e-9);
}

TEST_CASE(
    "mesh contacts: more triangles than there is room for: the nearest are kept, and it is told") {
    const ShapePtr fine = cooked(field(120, 0.0004, wavy)); // 28,800 triangles on 48 mm
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    const Placement at{{0.0, 0.004, 0.0}, Mat3(1.0)};
    const ClosestPoints found = ask(*pad, at, *fine, {}, kMargin);
    CHECK(found.left_out);
    // Off by less than the size of a triangle.
    CHECK(std::abs(smallest_gap(found) - brute_gap(*pad, at, *fine, {})) < 4e-4);
}

TEST_CASE("mesh contacts: a hole of a height map is one, and its border is felt") {
    ShapeDescription map;
    map.kind = ShapeKind::height_map;
    map.columns = map.rows = 11;
    map.spacing_x_m = map.spacing_z_m = 0.01;
    map.heights_m.assign(121, 0.0F);
    map.heights_m[5 * 11 + 5] = std::numeric_limits<float>::quiet_NaN(); // the middle
    const ShapePtr shape = cooked(map);
    const ToolPtr sphere = tool(make_sphere(0.004));
    CHECK(ask(*sphere, {{0.0, 0.003, 0.0}, Mat3(1.0)}, *shape, {}, 1e-3).count == 0);
    CHECK(ask(*sphere, {{0.02, 0.0045, 0.02}, Mat3(1.0)}, *shape, {}, 1e-3).count == 1);
    // Beside the corner at x = 10 mm, z = 0, half a millimetre inside the hole.
    const ClosestPoints border = ask(*sphere, {{0.0095, 0.004, 0.0}, Mat3(1.0)}, *shape, {}, 1e-3);
    REQUIRE(border.count == 1);
    CHECK(border.points[0].normal.x < -0.05);
}
