#include "bench/bench_touch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include <glm/geometric.hpp>

#include "bench/allocation_count.h"
#include "bench/wavy_field.h"
#include "core/geometry/rotation_log.h"
#include "device/contact/touch/touch_renderer.h"
#include "support/case_random.h"
#include "support/touch_gates.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kCycles = 60'000;
constexpr int kFrame = 16; // cycles of a game's frame
constexpr std::uint64_t kSeed = 9;

// A renderer whose device is put where a bench wants it, and a game that publishes 60 times a second.
class Hand {
public:
    explicit Hand(TouchScene scene) : touch(std::move(scene)) {
        renderer_.use(&memory_);
        renderer_.configure(ServoSettings());
        motion.grip.frame.rotation = Mat3(1.0);
    }
    // Times a cycle. Without a scene: nothing was published.
    Wrench cycle(SampleTimes &times, bool publishes = true) {
        time_s_ += kPeriod_s;
        Wrench felt;
        const bool frame = publishes && cycles_++ % kFrame == 0;
        if (frame) {
            touch.state_time_s = time_s_;
        }
        times.time([&] {
            (void)renderer_.age(kPeriod_s);
            if (frame) {
                (void)renderer_.accept(touch, ++sequence_, time_s_);
            }
            felt = renderer_.render(motion, kPeriod_s);
        });
        return felt;
    }
    TouchScene touch;
    GripMotion motion;

private:
    ProxyMemory memory_;
    TouchRenderer renderer_;
    double time_s_ = 0.0;
    std::uint64_t sequence_ = 0;
    int cycles_ = 0;
};

void report(const char *set, const char *mode, SampleTimes &times, double error,
            std::vector<BenchRow> &rows) {
    BenchRow row = make_row("ours", set, mode, times);
    row.worst_error = error;
    print_row(row);
    rows.push_back(row);
}

void nothing_near(std::vector<BenchRow> &rows) {
    const std::size_t cycles = limited(kCycles);
    SampleTimes times(cycles);
    Hand hand{TouchScene()};
    for (std::size_t i = 0; i < cycles; ++i) {
        hand.motion.grip.pose.position_m.x = 1e-5 * static_cast<double>(i % 100);
        (void)hand.cycle(times, i == 0);
    }
    report("nothing near", "moving", times, kNoFigure, rows);
}

enum class Kind { pads, held, pads_and_materials, held_on_hinge };

// A texture, static friction, adhesion and a magnet that is felt by what touches.
SurfaceTraits all_traits() {
    SurfaceTraits traits;
    traits.static_friction = 0.6;
    traits.adhesion_n = 0.5;
    traits.magnet_n = 0.5;
    traits.magnet_range_m = 0.003;
    traits.texture = {0.003, 0.0002, Vec3(0.0)};
    return traits;
}

// Boxes, balls, cylinders and hulls round the tool, which wanders among them and is pressed into them: eight, or ten
// with materials and where they are compared with.
TouchScene among_bodies(Kind kind, int bodies, test::CaseRandom &random) {
    const bool held = kind == Kind::held || kind == Kind::held_on_hinge;
    TouchScene touch;
    if (held) {
        ShapeDescription hull;
        hull.kind = ShapeKind::hull;
        for (int i = 0; i < 32; ++i) {
            const Vec3 way = random.vector(1.0) + Vec3(1e-9);
            hull.points_m.push_back(0.02 * way / glm::length(way));
        }
        test::add_tool(touch, make_tool(*test::cooked(std::move(hull))));
    } else {
        test::add_pads(touch);
    }
    for (int i = 0; i < bodies; ++i) {
        ShapeDescription shape;
        shape.kind = static_cast<ShapeKind>(i % 5);
        shape.half_extents_m = Vec3(0.02);
        shape.radius_m = 0.02;
        shape.half_height_m = 0.02;
        for (int k = 0; shape.kind == ShapeKind::hull && k < 20; ++k) {
            const Vec3 way = random.vector(1.0) + Vec3(1e-9);
            shape.points_m.push_back(0.025 * way / glm::length(way));
        }
        // At the corners of a cube: each is near.
        const Vec3 corner(i % 2 == 0 ? -1.0 : 1.0, i % 4 < 2 ? -1.0 : 1.0, i % 8 < 4 ? -1.0 : 1.0);
        ScenePart &part = test::add(touch, test::cooked(std::move(shape)),
                                    {(i < 8 ? 0.032 : 0.05) * corner, random.rotation(3.0)});
        part.friction = 0.4;
        part.traits = kind == Kind::pads_and_materials ? all_traits() : SurfaceTraits();
    }
    if (kind == Kind::held_on_hinge) {
        ToolJoint &joint = touch.tool.joints[0];
        joint.id = 1;
        joint.base.origin_m = Vec3(-0.08, 0.0, 0.0);
        joint.in_grip.origin_m = Vec3(-0.08, 0.0, 0.0);
        joint.axes[4] = {1.0, -1.0, 0.2};
        touch.tool.joint_count = 1;
    }
    return touch;
}

void among(const char *set, Kind kind, int bodies, std::vector<BenchRow> &rows) {
    test::CaseRandom random(kSeed, 1);
    const std::size_t cycles = limited(kCycles);
    SampleTimes times(cycles);
    Hand hand(among_bodies(kind, bodies, random));
    const std::size_t before = allocations().count;
    for (std::size_t i = 0; i < cycles; ++i) {
        const double t = kPeriod_s * static_cast<double>(i);
        hand.motion.grip.pose.position_m =
            0.03 * Vec3(std::sin(2.1 * t), std::sin(2.9 * t + 1.0), std::sin(1.7 * t + 2.0));
        hand.motion.grip.frame.rotation =
            rotation_exp(0.8 * Vec3(std::sin(1.1 * t), std::sin(0.9 * t), std::sin(1.3 * t)));
        hand.motion.grip.frame.grasp_angle_rad = 0.4 + 0.3 * std::sin(1.9 * t);
        (void)hand.cycle(times);
    }
    const std::size_t allocated = allocations().count - before;
    report(set, "moving", times, kNoFigure, rows);
    std::printf("    allocations %zu\n", allocated);
}

// A ball pressed 3 mm into the field: the force is exactly stiffness times depth along the normal.
long over_field(double speed_m_s, std::vector<BenchRow> &rows) {
    constexpr double kBall_m = 0.012;
    constexpr double kDepth_m = 0.003;
    constexpr double kStiffness_n_m = 700.0;
    constexpr int kCells = 224; // 100,352 triangles
    constexpr std::size_t kSettled = 200;
    const std::size_t cycles = limited(kCycles / 4);
    TouchScene touch;
    touch.damping_n_s_m = 0.0;
    test::add_tool(touch, make_sphere(kBall_m));
    test::add(touch, test::cooked(field(kCells)));
    for (std::size_t dof = 0; dof < 3; ++dof) {
        touch.stiffness[dof] = kStiffness_n_m;
    }
    Hand hand(std::move(touch));
    SampleTimes times(cycles);
    SampleTimes way_in(kSettled);
    double sum = 0.0;
    double squares = 0.0;
    double angles_rad = 0.0;
    long snags = 0;
    const auto at = [&](std::size_t i, double above_m) {
        return on_field(speed_m_s, kPeriod_s * static_cast<double>(i), above_m);
    };
    for (std::size_t i = 0; i < kSettled; ++i) {
        const double part = static_cast<double>(i) / kSettled;
        hand.motion.grip.pose.position_m =
            at(0, kBall_m + 0.002 - (0.002 + kDepth_m) * part).origin_m;
        (void)hand.cycle(way_in);
    }
    for (std::size_t i = 0; i < cycles; ++i) {
        const Placement exact = at(i, kBall_m - kDepth_m);
        hand.motion.grip.pose.position_m = exact.origin_m;
        const Vec3 force_n = hand.cycle(times).force_n;
        const double ratio = glm::length(force_n) / (kStiffness_n_m * kDepth_m);
        sum += ratio;
        squares += ratio * ratio;
        snags += std::abs(ratio - 1.0) > 0.5 ? 1 : 0;
        angles_rad += std::acos(
            std::clamp(glm::dot(force_n, exact.rotation[1]) / std::max(glm::length(force_n), 1e-12),
                       -1.0, 1.0));
    }
    const auto count = static_cast<double>(cycles);
    const double mean = sum / count;
    const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
    const char *const set =
        speed_m_s < 0.2 ? "ball on 100,000, 0.1 m/s" : "ball on 100,000, 0.4 m/s";
    report(set, "deviation of |F|/(K d)", times, deviation, rows);
    report(set, "direction (rad)", times, angles_rad / count, rows);
    std::printf("    mean %.5f, snags %ld\n", mean, snags);
    return snags;
}

void pads_over_field(std::vector<BenchRow> &rows) {
    const std::size_t cycles = limited(kCycles / 4);
    TouchScene touch;
    test::add_tool(touch, make_pad(0.012, 0.003, 0.003));
    test::add(touch, test::cooked(field(224)));
    Hand hand(std::move(touch));
    SampleTimes times(cycles);
    for (std::size_t i = 0; i < cycles; ++i) {
        const Placement at =
            on_field(0.4, kPeriod_s * static_cast<double>(i), i < 10 ? 0.004 : 0.0);
        hand.motion.grip.pose.position_m = at.origin_m;
        hand.motion.grip.frame.rotation = at.rotation;
        (void)hand.cycle(times);
    }
    report("pad on 100,000, 0.4 m/s", "3 mm deep", times, kNoFigure, rows);
}

} // namespace

int bench_touch(std::vector<BenchRow> &rows) {
    print_header("a servo cycle's part of real shapes (errors as the mode says)");
    nothing_near(rows);
    among("two pads, 8 bodies", Kind::pads, 8, rows);
    among("held hull, 8 bodies", Kind::held, 8, rows);
    among("two pads, 10 bodies", Kind::pads, 10, rows);
    among("the same, with materials", Kind::pads_and_materials, 10, rows);
    among("held hull on a hinge", Kind::held_on_hinge, 8, rows);
    const long snags = over_field(0.1, rows) + over_field(0.4, rows);
    pads_over_field(rows);
    return snags == 0 ? 0 : 1;
}

} // namespace spidar::bench
