#include "device/contact/shapes/shape_test_support.h"

#include "support/allocation_trap.h"

using namespace spidar;
using namespace spidar::test;

namespace {

void check_refused(const ShapeDescription &shape, Status status) {
    const CookResult result = cook(shape);
    CHECK(result.status == status);
    CHECK(result.sentence.size() > 10);
    CHECK_FALSE(result.shape);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_CASE("cooking: what is no shape is refused with a sentence") {
    ShapeDescription shape;
    shape.kind = ShapeKind::box;
    check_refused(shape, Status::invalid_shape); // no size
    shape.half_extents_m = {0.1, kNaN, 0.1};
    check_refused(shape, Status::not_finite);
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder}) {
        shape = {};
        shape.kind = kind;
        shape.half_height_m = 0.1;
        check_refused(shape, Status::invalid_shape);
        shape.radius_m = std::numeric_limits<double>::infinity();
        check_refused(shape, Status::not_finite);
    }
    shape = {};
    shape.kind = ShapeKind::hull;
    check_refused(shape, Status::invalid_shape); // empty
    shape.points_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    check_refused(shape, Status::invalid_shape); // flat
    shape.points_m[0].x = kNaN;
    check_refused(shape, Status::not_finite);
    shape = {};
    shape.kind = ShapeKind::mesh;
    check_refused(shape, Status::invalid_shape); // empty
    shape.points_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    shape.indices = {0, 1};
    check_refused(shape, Status::invalid_shape);
    shape.indices = {0, 1, 3};
    check_refused(shape, Status::invalid_shape);
    shape.indices = {0, 1, 1};
    check_refused(shape, Status::invalid_shape); // no area
    shape = {};
    shape.kind = ShapeKind::height_map;
    check_refused(shape, Status::invalid_shape);
    shape.columns = shape.rows = 2;
    shape.heights_m = {0.0F, 0.0F, 0.0F};
    check_refused(shape, Status::invalid_shape);
    shape.heights_m.assign(4, std::numeric_limits<float>::quiet_NaN());
    check_refused(shape, Status::invalid_shape); // nothing but holes
    shape.heights_m.assign(4, std::numeric_limits<float>::infinity());
    check_refused(shape, Status::not_finite);
    shape = {};
    shape.kind = ShapeKind::half_space;
    shape.normal = Vec3(0.0);
    check_refused(shape, Status::invalid_shape);
    shape.normal = {0, kNaN, 0};
    check_refused(shape, Status::not_finite);
}

TEST_CASE("cooking: triangles without area are dropped and counted") {
    ShapeDescription shape = box_mesh({0.1, 0.1, 0.1});
    shape.indices.insert(shape.indices.end(), {0, 0, 1, 0, 1, 1});
    const CookResult result = cook(shape);
    REQUIRE(result.shape);
    CHECK(result.dropped_triangles == 2);
    CHECK(result.sentence.find("2 triangles") == 0);
    // Corners given once for each triangle, as an engine has them, are the same mesh.
    ShapeDescription soup;
    soup.kind = ShapeKind::mesh;
    for (const std::uint32_t index : box_mesh({0.1, 0.1, 0.1}).indices) {
        soup.indices.push_back(static_cast<std::uint32_t>(soup.points_m.size()));
        soup.points_m.push_back(shape.points_m[index]);
    }
    const ShapePtr welded = cooked(soup);
    CHECK(welded->data().description.points_m.size() == 8);
    for (const auto &neighbours : welded->data().neighbours) {
        for (const std::uint32_t neighbour : neighbours) {
            CHECK(neighbour != kNone); // a closed box has no border
        }
    }
}

TEST_CASE("cooking: bounds, and the corners and faces of a hull") {
    const ShapePtr can = round_shape(ShapeKind::cylinder, 0.04, 0.03);
    CHECK(glm::length(can->upper_m() - Vec3(0.04, 0.03, 0.04)) < 1e-12);
    CHECK(glm::length(can->lower_m() + Vec3(0.04, 0.03, 0.04)) < 1e-12);
    const ShapePtr pill = round_shape(ShapeKind::capsule, 0.02, 0.05);
    CHECK(glm::length(pill->upper_m() - Vec3(0.02, 0.07, 0.02)) < 1e-12);
    CHECK(pill->bytes() > 0);
    std::vector<Vec3> cube{{0.001, 0.0, 0.002}}; // a point inside is none of the hull
    for (int i = 0; i < 8; ++i) {
        cube.emplace_back((i & 1) != 0 ? 0.01 : -0.01, (i & 2) != 0 ? 0.01 : -0.01,
                          (i & 4) != 0 ? 0.01 : -0.01);
    }
    const ShapePtr made = hull(cube);
    CHECK(made->data().core.points.size() == 8);
    REQUIRE(made->data().core.faces.size() == 6);
    for (const HullFace &face : made->data().core.faces) {
        CHECK(face.count == 4);
        CHECK(std::abs(face.offset_m - 0.01) < 1e-12);
    }
    // Small and far from the origin, all the same.
    CaseRandom random(31, 0);
    std::vector<Vec3> points = random_points(random, 100, 0.002);
    for (Vec3 &point : points) {
        point += Vec3(3.0, -2.0, 1.0);
    }
    const ShapePtr tiny = hull(points);
    for (const HullFace &face : tiny->data().core.faces) {
        for (const Vec3 &point : points) {
            CHECK(glm::dot(face.normal, point) < face.offset_m + 1e-8);
        }
    }
}

TEST_CASE("tools: a body made a tool keeps its faces where they are") {
    CaseRandom random(32, 0);
    const double skin = 1e-3;
    const std::vector<ShapePtr> shapes{
        box({0.02, 0.01, 0.03}), round_shape(ShapeKind::cylinder, 0.02, 0.01),
        round_shape(ShapeKind::capsule, 0.01, 0.02), hull(random_points(random, 40, 0.03))};
    for (const ShapePtr &shape : shapes) {
        const ToolPtr made = tool(make_tool(*shape, skin));
        const ConvexCore &core = made->data().core;
        for (const HullFace &face : shape->data().core.faces) {
            const double reach = glm::dot(face.normal, support(view_of(core), face.normal)) + skin;
            CHECK(reach < face.offset_m + 1e-7);
        }
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 way(0.0);
            way[axis] = 1.0;
            const double reach = glm::dot(way, support(view_of(core), way)) + made->skin_m();
            CHECK(reach < shape->upper_m()[axis] + 1e-7);
            if (shape->kind() != ShapeKind::hull) {
                CHECK(std::abs(reach - shape->upper_m()[axis]) < 1e-12);
            }
        }
    }
    // Large faces of a hull stay: a prism of a bar, 200 mm long.
    std::vector<Vec3> bar;
    for (int i = 0; i < 8; ++i) {
        bar.emplace_back((i & 1) != 0 ? 0.1 : -0.1, (i & 2) != 0 ? 0.005 : -0.005,
                         (i & 4) != 0 ? 0.01 : -0.01);
    }
    const ShapePtr prism = hull(bar);
    const ToolPtr held = tool(make_tool(*prism, skin));
    CHECK(held->skin_m() == skin);
    for (const HullFace &face : prism->data().core.faces) {
        const Vec3 end = support(view_of(held->data().core), face.normal);
        CHECK(std::abs(glm::dot(face.normal, end) + skin - face.offset_m) < 1e-7);
    }
    const ToolPtr thin = tool(make_tool(*box({0.1, 0.0006, 0.1}), skin));
    CHECK(thin->skin_m() == doctest::Approx(0.0003));
}

TEST_CASE("tools: what is no tool is refused with a sentence") {
    const std::vector<ToolResult> refused{make_pad(0.0, 0.003, 0.001),
                                          make_pad(0.012, 0.003, 0.004),
                                          make_pad(0.003, 0.003, 0.003),
                                          make_pad(kNaN, 0.003, 0.001),
                                          make_sphere(-1.0),
                                          make_tool(*box({1, 1, 1}), 0.0),
                                          make_tool(*half_space({0, 1, 0}, 0.0)),
                                          make_tool(*cooked(box_mesh({1, 1, 1})))};
    for (const ToolResult &result : refused) {
        CHECK(result.status == Status::invalid_shape);
        CHECK(result.sentence.size() > 10);
        CHECK_FALSE(result.tool);
    }
}

TEST_CASE("closest points: nothing is allocated, whatever is asked") {
    CaseRandom random(33, 0);
    const ShapeDescription mesh =
        field(40, 0.003, [](double x, double z) { return 0.01 * std::sin(90.0 * x + 60.0 * z); });
    const std::vector<ShapePtr> shapes{box({0.05, 0.02, 0.08}),
                                       round_shape(ShapeKind::sphere, 0.03),
                                       round_shape(ShapeKind::cylinder, 0.04, 0.03),
                                       hull(random_points(random, 32, 0.05)),
                                       half_space({0, 1, 0}, 0.0),
                                       cooked(mesh),
                                       cooked(as_height_map(mesh, 40, 0.003))};
    const std::vector<ToolPtr> tools{tool(make_sphere(0.012)), tool(make_pad(0.012, 0.003, 0.003)),
                                     tool(make_pad(0.012, 0.003, 0.001)),
                                     tool(make_tool(*hull(random_points(random, 20, 0.01))))};
    auto memory = std::make_unique<PairMemory>();
    ClosestPoints out;
    int found = 0;
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
        for (const ShapePtr &shape : shapes) {
            for (const ToolPtr &tool : tools) {
                const Placement at{random.vector(0.06), random.rotation(3.0)};
                memory->forget();
                const std::size_t before = allocations_of_this_thread();
                static_cast<void>(closest_points(*tool, at, *shape, {}, 4e-3, *memory, out));
                CHECK(allocations_of_this_thread() == before);
                found += out.count > 0 ? 1 : 0;
                inside += out.count > 0 && out.points[0].core_inside ? 1 : 0;
            }
        }
    }
    CHECK(found > 1000);
    CHECK(inside > 100); // ways out of an overlap too
}
