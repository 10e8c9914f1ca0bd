#include "device/contact/shapes/shape_test_support.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kFar = 10.0; // a margin that leaves nothing out

// Signed distance of a point to a box about the origin (m).
double box_distance(const Vec3 &point, const Vec3 &half) {
    const Vec3 q = glm::abs(point) - half;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

double capsule_distance(const Vec3 &point, double radius, double half_height) {
    const double y = std::fmin(std::fmax(point.y, -half_height), half_height);
    return glm::length(point - Vec3(0.0, y, 0.0)) - radius;
}

double cylinder_distance(const Vec3 &point, double radius, double half_height) {
    const double across = std::hypot(point.x, point.z) - radius;
    const double along = std::abs(point.y) - half_height;
    return std::hypot(std::max(across, 0.0), std::max(along, 0.0)) +
           std::min(std::max(across, along), 0.0);
}

Vec3 into(const Placement &at, const Vec3 &point) {
    return glm::transpose(at.rotation) * (point - at.origin_m);
}

Placement placed(CaseRandom &random, double size_m) {
    return {random.vector(size_m), random.rotation(3.0)};
}

// The points lie on both bodies, and a plane between them keeps both bodies apart by the whole gap: no two points of the
// bodies are nearer.
void check_optimal(const ToolShape &tool, const Placement &tool_at, const CookedShape &shape,
                   const Placement &shape_at, const ClosestPoints &found, double tolerance_m) {
    REQUIRE(found.count > 0);
    const ContactPoint &nearest = found.points[0];
    const ToolShape::Data &t = tool.data();
    const CookedShape::Data &s = shape.data();
    const Vec3 tool_way = glm::transpose(tool_at.rotation) * -nearest.normal;
    const Vec3 shape_way = glm::transpose(shape_at.rotation) * nearest.normal;
    const Vec3 tool_end = tool_at.origin_m + tool_at.rotation * support(view_of(t.core), tool_way) -
                          t.skin_m * nearest.normal;
    const Vec3 shape_end = shape_at.origin_m +
                           shape_at.rotation * support(view_of(s.core), shape_way) +
                           s.skin_m * nearest.normal;
    // Nothing is nearer than the plane says ...
    CHECK(std::abs(glm::dot(tool_end - shape_end, nearest.normal) - nearest.gap_m) < tolerance_m);
    // ... and the two points are as near as that.
    CHECK(glm::length(nearest.on_tool_m - nearest.on_shape_m - nearest.gap_m * nearest.normal) <
          tolerance_m);
}

bool in_core(const ConvexCore &core, const Vec3 &point, double slack_m) {
    switch (core.kind) {
    case CoreKind::point:
        return glm::length(point) < slack_m;
    case CoreKind::segment:
        return capsule_distance(point, 0.0, core.half_height_m) < slack_m;
    case CoreKind::disc:
    case CoreKind::cylinder:
        return cylinder_distance(point, core.radius_m, core.half_height_m) < slack_m;
    case CoreKind::box:
        return box_distance(point, core.half_m) < slack_m;
    case CoreKind::points:
        break;
    }
    for (const HullFace &face : core.faces) {
        if (glm::dot(face.normal, point) > face.offset_m + slack_m) {
            return false;
        }
    }
    return true;
}

} // namespace

TEST_CASE("closest points: a sphere and each shape whose distance to a point is known") {
    CaseRandom random(11, 0);
    const Vec3 half(0.05, 0.02, 0.08);
    const ShapePtr ball = round_shape(ShapeKind::sphere, 0.03);
    const ShapePtr brick = box(half);
    const ShapePtr pill = round_shape(ShapeKind::capsule, 0.02, 0.05);
    const ShapePtr can = round_shape(ShapeKind::cylinder, 0.04, 0.03);
    const double radius = 0.006;
    const ToolPtr sphere = tool(make_sphere(radius));
    for (int i = 0; i < 2000; ++i) {
        const Placement shape_at = placed(random, 0.1);
        const Placement tool_at = placed(random, 0.15);
        const Vec3 point = into(shape_at, tool_at.origin_m);
        const struct {
            const CookedShape &shape;
            double distance;
        } cases[] = {{*ball, glm::length(point) - 0.03},
                     {*brick, box_distance(point, half)},
                     {*pill, capsule_distance(point, 0.02, 0.05)},
                     {*can, cylinder_distance(point, 0.04, 0.03)}};
        for (const auto &known : cases) {
            const ClosestPoints found = ask(*sphere, tool_at, known.shape, shape_at, kFar);
            check_points(found, kFar);
            if (known.distance < 1e-5) {
                continue; // the core is inside: recovery
            }
            REQUIRE(found.count == 1);
            CHECK(std::abs(found.points[0].gap_m - (known.distance - radius)) < 1e-9);
            check_optimal(*sphere, tool_at, known.shape, shape_at, found, 1e-9);
        }
    }
}

TEST_CASE("closest points: any tool and any convex shape; the answer proves itself") {
    CaseRandom random(12, 0);
    const std::vector<ShapePtr> shapes{box({0.05, 0.02, 0.08}),
                                       box({20.0, 0.5, 20.0}),
                                       round_shape(ShapeKind::capsule, 0.02, 0.05),
                                       round_shape(ShapeKind::cylinder, 0.04, 0.03),
                                       hull(random_points(random, 32, 0.05)),
                                       hull(random_points(random, 4, 0.05)),
                                       hull(random_points(random, 300, 0.05))};
    const std::vector<ToolPtr> tools{
        tool(make_pad(0.012, 0.003, 0.003)),
        tool(make_pad(0.012, 0.003, 0.001)),
        tool(make_sphere(0.006)),
        tool(make_tool(*shapes[0])),
        tool(make_tool(*shapes[2])),
        tool(make_tool(*shapes[3])),
        tool(make_tool(*shapes[4])),
    };
    int apart = 0;
    for (int i = 0; i < 400; ++i) {
        for (const ShapePtr &shape : shapes) {
            for (const ToolPtr &tool : tools) {
                const Placement shape_at = placed(random, 0.1);
                const double away = random.spread(0.01, 0.3);
                const Placement tool_at{shape_at.origin_m + random.vector(away) +
                                            (shape == shapes[1]
                                                 ? shape_at.rotation * Vec3(0, 0.5 + away, 0)
                                                 : Vec3(0.0)),
                                        random.rotation(3.0)};
                const ClosestPoints found = ask(*tool, tool_at, *shape, shape_at, kFar);
                check_points(found, kFar);
                REQUIRE(found.count > 0);
                if (found.points[0].core_inside) {
                    continue;
                }
                ++apart;
                // A box of 40 m has corners whose last bit is 4e-15 m: the large one is as exact as the others.
                check_optimal(*tool, tool_at, *shape, shape_at, found, 1e-8);
                const ContactPoint &nearest = found.points[0];
                const ToolShape::Data &t = tool->data();
                CHECK(in_core(t.core, into(tool_at, nearest.on_tool_m + t.skin_m * nearest.normal),
                              1e-8));
                const CookedShape::Data &s = shape->data();
                CHECK(in_core(
                    s.core, into(shape_at, nearest.on_shape_m - s.skin_m * nearest.normal), 1e-8));
            }
        }
    }
    CHECK(apart > 10000);
}

TEST_CASE("closest points: a flat pad stands on four points, a tilted one on its lowest") {
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    const ShapePtr block = box({0.1, 0.05, 0.1});
    const ShapePtr floor = half_space({0, 1, 0}, 0.05);
    for (const ShapePtr &shape : {block, floor}) {
        const ClosestPoints flat = ask(*pad, {{0, 0.055, 0}, Mat3(1.0)}, *shape, {}, 0.01);
        check_points(flat, 0.01);
        REQUIRE(flat.count == 4);
        Vec3 middle(0.0);
        for (int i = 0; i < 4; ++i) {
            const ContactPoint &point = flat.points[static_cast<std::size_t>(i)];
            CHECK(std::abs(point.gap_m - 0.002) < 1e-12);
            CHECK(glm::length(point.normal - Vec3(0, 1, 0)) < 1e-9);
            middle += 0.25 * point.on_tool_m;
        }
        CHECK(glm::length(middle - Vec3(0, 0.052, 0)) < 0.0035); // they surround the middle
        const double tilt = 0.2;
        const Mat3 turn = glm::mat3_cast(glm::angleAxis(tilt, Vec3(0, 0, 1)));
        const ClosestPoints tilted = ask(*pad, {{0, 0.055, 0}, turn}, *shape, {}, 0.01);
        REQUIRE(tilted.count > 1);
        CHECK(std::abs(tilted.points[0].gap_m - (0.005 - 0.009 * std::sin(tilt) - 0.003)) < 1e-10);
        CHECK(tilted.points[0].on_tool_m.x < -0.008);
    }
}

TEST_CASE("closest points: a bar across a block touches along the block's edges") {
    const ShapePtr bar = box({0.1, 0.01, 0.01});
    const ToolPtr held = tool(make_tool(*bar));
    const ShapePtr block = box({0.01, 0.05, 0.05}); // its top is 20 mm wide
    const ClosestPoints found = ask(*held, {{0.08, 0.061, 0}, Mat3(1.0)}, *block, {}, 0.003);
    check_points(found, 0.003);
    check_stands_on_edges(found, 0.01, 0.001, 1e-10);
}

TEST_CASE("closest points: the margin decides what is told, and far shapes cost nothing") {
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    const ShapePtr block = box({0.1, 0.05, 0.1});
    const Placement at{{0, 0.06, 0}, Mat3(1.0)}; // 7 mm away
    CHECK(ask(*pad, at, *block, {}, 0.0069).count == 0);
    CHECK(ask(*pad, at, *block, {}, 0.0071).count == 4);
    // Inside the skin: a negative gap, still exact.
    const ClosestPoints pressed = ask(*pad, {{0, 0.051, 0}, Mat3(1.0)}, *block, {}, 0.001);
    REQUIRE(pressed.count > 0);
    CHECK(std::abs(pressed.points[0].gap_m + 0.002) < 1e-10);
    CHECK_FALSE(pressed.points[0].core_inside);
}

TEST_CASE("closest points: overlapping cores are told, with a way out of known length") {
    CaseRandom random(13, 0);
    const ShapePtr block = box({0.05, 0.04, 0.06});
    const ToolPtr bar = tool(make_tool(*box({0.03, 0.01, 0.02})));
    for (int i = 0; i < 200; ++i) {
        const Placement shape_at = placed(random, 0.1);
        // The nearest face is +Y: 5 mm deep.
        const Vec3 place(random.between(-0.01, 0.01), 0.045, random.between(-0.01, 0.01));
        const Placement tool_at = shape_at * Placement{place, Mat3(1.0)};
        const ClosestPoints found = ask(*bar, tool_at, *block, shape_at, 0.001);
        REQUIRE(found.count > 0);
        CHECK(found.points[0].core_inside);
        CHECK(std::abs(found.points[0].gap_m + 0.005) < 1e-5);
        CHECK(glm::length(found.points[0].normal - shape_at.rotation[1]) < 2e-3);
    }
    // Whatever overlaps: moved out along the normal by the gap, the cores are apart.
    const std::vector<ShapePtr> shapes{block, round_shape(ShapeKind::cylinder, 0.04, 0.03),
                                       hull(random_points(random, 32, 0.05))};
    const std::vector<ToolPtr> tools{tool(make_pad(0.012, 0.003, 0.003)), bar,
                                     tool(make_sphere(0.006))};
    for (int i = 0; i < 500; ++i) {
        for (const ShapePtr &shape : shapes) {
            for (const ToolPtr &tool : tools) {
                Placement tool_at = placed(random, 0.02);
                const ClosestPoints found = ask(*tool, tool_at, *shape, {}, 0.001);
                REQUIRE(found.count > 0);
                if (!found.points[0].core_inside) {
                    continue;
                }
                tool_at.origin_m -= (found.points[0].gap_m - 1e-4) * found.points[0].normal;
                const ClosestPoints out = ask(*tool, tool_at, *shape, {}, 0.01);
                REQUIRE(out.count > 0);
                CHECK_FALSE(out.points[0].core_inside);
                CHECK(out.points[0].gap_m > 0.0);
            }
        }
    }
}

TEST_CASE("closest points: what was remembered changes nothing") {
    CaseRandom random(14, 0);
    const ShapePtr shape = hull(random_points(random, 32, 0.05));
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    auto memory = std::make_unique<PairMemory>();
    Placement at{{0.0, 0.07, 0.0}, Mat3(1.0)};
    for (int i = 0; i < 3000; ++i) {
        at.origin_m += random.vector(3e-4);
        at.rotation = at.rotation * random.rotation(0.02);
        ClosestPoints found;
        REQUIRE(closest_points(*pad, at, *shape, {}, 1.0, *memory, found) == Status::ok);
        const ClosestPoints fresh = ask(*pad, at, *shape, {}, 1.0);
        REQUIRE(found.count > 0);
        if (fresh.points[0].core_inside) {
            continue;
        }
        CHECK(std::abs(found.points[0].gap_m - fresh.points[0].gap_m) < 1e-9);
    }
}

TEST_CASE("closest points: a placement or a margin that is not finite is refused") {
    const ToolPtr pad = tool(make_pad(0.012, 0.003, 0.003));
    const ShapePtr block = box({0.1, 0.05, 0.1});
    auto memory = std::make_unique<PairMemory>();
    ClosestPoints out;
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Placement at;
        at.origin_m.y = bad;
        Placement turned;
        turned.rotation[1][2] = bad;
        CHECK(closest_points(*pad, at, *block, {}, 0.01, *memory, out) == Status::not_finite);
        CHECK(closest_points(*pad, {}, *block, turned, 0.01, *memory, out) == Status::not_finite);
        CHECK(closest_points(*pad, {}, *block, {}, bad, *memory, out) == Status::not_finite);
        CHECK(out.count == 0);
    }
}
