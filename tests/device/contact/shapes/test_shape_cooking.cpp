#include "device/contact/shapes/shape_test_support.h"

#include <cmath>
#include <cstring>

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

namespace {

// Of every kind, with values that rounding touches.
std::vector<ShapeDescription> descriptions() {
    CaseRandom random(77, 0);
    std::vector<ShapeDescription> all;
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::sphere, ShapeKind::capsule,
                                 ShapeKind::cylinder, ShapeKind::hull, ShapeKind::half_space}) {
        ShapeDescription shape;
        shape.kind = kind;
        shape.half_extents_m = Vec3(0.011, 0.0123, 0.017);
        shape.radius_m = 0.0131;
        shape.half_height_m = 0.0177;
        shape.points_m = kind == ShapeKind::hull ? random_points(random, 40, 0.02) : shape.points_m;
        shape.normal = Vec3(0.3, 1.1, -0.7);
        shape.offset_m = 0.004;
        all.push_back(shape);
    }
    ShapeDescription mesh = field(9, 0.004, [](double x, double z) {
        return 0.003 * std::sin(300.0 * x) * std::cos(200.0 * z);
    });
    mesh.points_m.push_back(mesh.points_m[7]); // welded
    mesh.indices.insert(mesh.indices.end(), {3, 3, 4, 100, 8, 17});
    all.push_back(mesh);
    mesh.two_sided = true;
    all.push_back(mesh);
    mesh.points_m.resize(100);
    ShapeDescription map = as_height_map(mesh, 9, 0.004);
    map.heights_m[14] = std::numeric_limits<float>::quiet_NaN();
    all.push_back(map);
    return all;
}

bool same_bits(const Vec3 &a, const Vec3 &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

} // namespace

TEST_CASE("cooking: what a shape or a tool was made of gives the same one, to the bit") {
    CaseRandom random(78, 0);
    int points = 0;
    for (const ShapeDescription &description : descriptions()) {
        const ShapePtr shape = cooked(description);
        const ShapePtr again = cooked(shape->description());
        CHECK(again->number() != shape->number());
        std::vector<ToolPtr> tools = {tool(make_pad(0.0101, 0.003, 0.0007)),
                                      tool(make_sphere(0.0123))};
        if (shape->convex() && shape->kind() != ShapeKind::half_space) {
            tools.push_back(tool(make_tool(*shape)));
            tools.push_back(tool(make_tool(*shape, 0.1))); // thinner than asked for
        }
        for (const ToolPtr &one : tools) {
            const ToolPtr other = tool(make_tool(one->description()));
            CHECK(other->reach_m() == one->reach_m());
            CHECK(other->skin_m() == one->skin_m());
            for (int i = 0; i < 40; ++i) {
                const Placement at{random.vector(0.04), random.rotation(3.0)};
                const ClosestPoints a = ask(*one, at, *shape, {}, 0.02);
                const ClosestPoints b = ask(*other, at, *again, {}, 0.02);
                REQUIRE(a.count == b.count);
                points += a.count;
                for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) {
                    const ContactPoint &p = a.points[k];
                    const ContactPoint &q = b.points[k];
                    CHECK(same_bits(p.on_tool_m, q.on_tool_m));
                    CHECK(same_bits(p.on_shape_m, q.on_shape_m));
                    CHECK(same_bits(p.normal, q.normal));
                    CHECK(p.gap_m == q.gap_m);
                    CHECK(p.face == q.face);
                    CHECK(p.core_inside == q.core_inside);
                }
            }
        }
    }
    CHECK(points > 1000);
    ToolDescription wrong;
    wrong.kind = static_cast<ToolKind>(9);
    CHECK(make_tool(wrong).sentence.find("unknown") != std::string::npos);
    wrong.kind = ToolKind::shape;
    CHECK(make_tool(wrong).sentence.find("half_extents_m") != std::string::npos);
}

TEST_CASE("cooking: sizes at the ends of what a number holds are refused or cooked, and end") {
    for (const double size : {1e-300, 1e-40, 1e-9, 1.0, 1e5, 1e6, 1e7, 1e39, 1e300}) {
        for (ShapeDescription description : descriptions()) {
            description.half_extents_m *= size / 0.02;
            description.radius_m *= size / 0.02;
            description.half_height_m *= size / 0.02;
            description.normal *= size;
            for (Vec3 &point : description.points_m) {
                point *= size / 0.02;
            }
            const CookResult made = cook(description);
            const bool told = made.sentence.size() > 10;
            CHECK(told == (made.shape == nullptr || made.dropped_triangles > 0));
            if (made.shape != nullptr && made.shape->kind() != ShapeKind::mesh) {
                (void)make_tool(*made.shape);
            }
        }
    }
}
