#include "bench/bench_motions.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "bench/wavy_field.h"
#include "core/geometry/rotation_log.h"
#include "device/contact/contact_renderer.h"
#include "device/contact/touch/touch_renderer.h"
#include "support/touch_scenes.h"

namespace spidar::bench {

namespace {

constexpr double kSettle_s = 0.5;
constexpr double kTime_s = 4.0;
constexpr double kStiffness_n_m = 1000.0;
constexpr double kTurn_nm_rad = 2.0;
constexpr int kFinerSteps = 20; // of the ideal one in a cycle
constexpr int kFrameRates_hz[] = {30, 60, 90, 144};

// Where the shape is and how it moves.
struct Body {
    Placement at;
    Vec3 velocity_m_s{0.0};
};

struct Motion {
    std::string name;
    std::shared_ptr<const CookedShape> shape;
    ToolResult tool;
    double radius_m = 0.0; // of the ball that the old way takes the tool for
    std::function<ToolPose(double)> hand;
    std::function<Body(double)> body;
};

DofGains stiffness() {
    return {kStiffness_n_m,
            kStiffness_n_m,
            kStiffness_n_m,
            kTurn_nm_rad,
            kTurn_nm_rad,
            kTurn_nm_rad,
            0.4};
}

GripMotion motion_of(const ToolPose &pose) {
    GripMotion motion;
    motion.grip.pose.position_m = pose.position_m;
    motion.grip.frame.rotation = pose.rotation;
    return motion;
}

// Real shapes in the servo loop.
class NewWay {
public:
    explicit NewWay(const Motion &motion) {
        renderer_.use(&memory_);
        ServoSettings settings;
        settings.render.caps_from_latency = false; // all three ways with the same springs
        renderer_.configure(settings);
        touch_.stiffness = stiffness();
        touch_.damping_n_s_m = 0.0;
        test::add_tool(touch_, motion.tool);
        part_ = &test::add(touch_, motion.shape);
    }
    void frame(const Body &body, const ToolPose &, double now_s) {
        part_->at = body.at;
        part_->velocity_m_s = body.velocity_m_s;
        touch_.state_time_s = now_s;
        fresh_ = true;
    }
    Wrench cycle(const ToolPose &hand, double now_s) {
        (void)renderer_.age(kPeriod_s);
        if (fresh_) {
            (void)renderer_.accept(touch_, ++sequence_, now_s);
            fresh_ = false;
        }
        return renderer_.render(motion_of(hand), kPeriod_s);
    }

private:
    ProxyMemory memory_;
    TouchRenderer renderer_;
    TouchScene touch_;
    ScenePart *part_ = nullptr;
    std::uint64_t sequence_ = 0;
    bool fresh_ = false;
};

// A plane for the body, once a frame, where it is nearest to the grip's centre: what contacts from a script are.
class OldWay {
public:
    explicit OldWay(const Motion &motion)
        : ball_(make_sphere(motion.radius_m)), shape_(motion.shape) {
        ServoSettings settings;
        settings.render.caps_from_latency = false;
        renderer_.configure(settings);
    }
    void frame(const Body &body, const ToolPose &hand, double now_s) {
        constexpr double kReach_m = 0.05;
        ClosestPoints found;
        (void)closest_points(*ball_.tool, {hand.position_m, Mat3(1.0)}, *shape_, body.at, kReach_m,
                             memory_, found);
        command_.contact_count = found.count > 0 ? 1 : 0;
        ContactPlane &plane = command_.contacts[0];
        plane.stiffness_n_m = kStiffness_n_m;
        plane.damping_n_s_m = 0.0;
        if (found.count > 0) {
            plane.normal = found.points[0].normal;
            plane.offset_m =
                glm::dot(found.points[0].on_shape_m, plane.normal) + ball_.tool->skin_m();
            plane.velocity_m_s = body.velocity_m_s;
        }
        command_.contacts_state_time_s = now_s;
        fresh_ = true;
    }
    Wrench cycle(const ToolPose &hand, double now_s) {
        (void)renderer_.age(kPeriod_s);
        if (fresh_) {
            (void)renderer_.accept(command_, now_s);
            fresh_ = false;
        }
        return renderer_.render(motion_of(hand), kPeriod_s);
    }

private:
    ToolResult ball_;
    std::shared_ptr<const CookedShape> shape_;
    PairMemory memory_{};
    ContactRenderer renderer_;
    HapticCommand command_;
    bool fresh_ = false;
};

// The proxy itself, with the scene as it is at each moment.
class Ideal {
public:
    explicit Ideal(const Motion &motion) : motion_(motion) {
        ProxySettings settings;
        settings.stiffness = stiffness();
        settings.damping_s = 0.0;
        proxy_.configure(settings);
        tool_.parts[0].shape = motion.tool.tool.get();
        tool_.count = 1;
        scene_.parts[0].shape = motion.shape.get();
        scene_.count = 1;
    }
    Wrench cycle(double now_s) {
        for (int i = 1 - kFinerSteps; i <= 0; ++i) {
            const double at_s = now_s + i * kPeriod_s / kFinerSteps;
            scene_.parts[0].at = motion_.body(at_s).at;
            proxy_.update(tool_, scene_, motion_.hand(at_s), {}, 0.0, memory_);
        }
        return proxy_.wrench();
    }

private:
    const Motion &motion_;
    ProxyMemory memory_;
    ToolProxy proxy_;
    Tool tool_;
    ContactScene scene_;
};

// Rows of one way: root of the mean square of the force's error, then of the moment's.
template <typename Way>
void run(const char *method, const Motion &motion, int frames_hz, std::vector<BenchRow> &rows) {
    Way way(motion);
    Ideal ideal(motion);
    const std::size_t cycles =
        std::max<std::size_t>(limited(static_cast<std::size_t>((kSettle_s + kTime_s) / kPeriod_s)),
                              static_cast<std::size_t>(2.0 * kSettle_s / kPeriod_s));
    SampleTimes times(cycles);
    double next_frame_s = 0.0;
    double force_n2 = 0.0;
    double moment_nm2 = 0.0;
    double counted = 0.0;
    for (std::size_t i = 1; i <= cycles; ++i) {
        const double now_s = kPeriod_s * static_cast<double>(i);
        const ToolPose hand = motion.hand(now_s);
        if (now_s >= next_frame_s) {
            way.frame(motion.body(now_s), hand, now_s);
            next_frame_s += 1.0 / frames_hz;
        }
        Wrench felt;
        times.time([&] { felt = way.cycle(hand, now_s); });
        const Wrench due = ideal.cycle(now_s);
        if (now_s > kSettle_s) {
            const Vec3 force_n = felt.force_n - due.force_n;
            const Vec3 moment_nm = felt.moment_nm - due.moment_nm;
            force_n2 += glm::dot(force_n, force_n);
            moment_nm2 += glm::dot(moment_nm, moment_nm);
            counted += 1.0;
        }
    }
    const std::string set = motion.name + ", " + std::to_string(frames_hz) + " Hz";
    BenchRow row = make_row(method, set, "force", times);
    row.worst_error = std::sqrt(force_n2 / counted);
    print_row(row);
    rows.push_back(row);
    row.mode = "moment";
    row.worst_error = std::sqrt(moment_nm2 / counted);
    print_row(row);
    rows.push_back(row);
}

// Its time, and no error: it is what the others are measured by.
void run_ideal(const Motion &motion, std::vector<BenchRow> &rows) {
    Ideal ideal(motion);
    const std::size_t cycles = limited(static_cast<std::size_t>(kTime_s / kPeriod_s));
    SampleTimes times(cycles);
    for (std::size_t i = 1; i <= cycles; ++i) {
        times.time([&] { (void)ideal.cycle(kPeriod_s * static_cast<double>(i)); });
    }
    BenchRow row = make_row("without a game", motion.name + ", each cycle", "force", times);
    row.worst_error = 0.0;
    print_row(row);
    rows.push_back(row);
    row.mode = "moment";
    rows.push_back(row);
}

double swing(double hz, double time_s) {
    return std::sin(2.0 * std::numbers::pi * hz * time_s);
}

// Pressed in during the first half of what settles.
double pressed(double depth_m, double time_s) {
    return 0.002 - (0.002 + depth_m) * std::min(1.0, 2.0 * time_s / kSettle_s);
}

std::vector<Motion> motions() {
    constexpr double kBall_m = 0.012;
    const auto still = [](double) { return Body(); };
    const auto at = [](const Vec3 &position_m, const Vec3 &turn_rad = Vec3(0.0)) {
        ToolPose pose;
        pose.position_m = position_m;
        pose.rotation = rotation_exp(turn_rad);
        return pose;
    };
    std::vector<Motion> all;
    all.push_back(
        {"ball over waves", test::cooked(field(224)), make_sphere(kBall_m), kBall_m,
         [at](double t) { return at(on_field(0.3, t, kBall_m + pressed(0.003, t)).origin_m); },
         still});
    all.push_back({"ball round an edge", test::box(Vec3(0.03)), make_sphere(kBall_m), kBall_m,
                   [at](double t) {
                       const double angle = 0.7 * swing(0.5, t);
                       return at(Vec3(0.03, 0.03, 0.0) +
                                 (kBall_m + pressed(0.003, t)) *
                                     Vec3(std::sin(angle + 0.785), std::cos(angle + 0.785), 0.0));
                   },
                   still});
    all.push_back({"moving block", test::box(Vec3(0.05, 0.02, 0.05)), make_sphere(kBall_m), kBall_m,
                   [at](double t) { return at(Vec3(0.0, kBall_m + pressed(0.006, t), 0.0)); },
                   [](double t) {
                       constexpr double kHz = 1.0;
                       constexpr double kWay_m = 0.003;
                       const double rate = 2.0 * std::numbers::pi * kHz;
                       return Body{{Vec3(0.0, -0.02 + kWay_m * swing(kHz, t), 0.0), Mat3(1.0)},
                                   Vec3(0.0, kWay_m * rate * std::cos(rate * t), 0.0)};
                   }});
    all.push_back({"bar on an edge", test::box(Vec3(0.03, 0.03, 0.05)),
                   make_tool(*test::box(Vec3(0.1, 0.008, 0.012))), 0.008,
                   [at](double t) {
                       return at(Vec3(-0.07, 0.038 + pressed(0.004, t), 0.01 * swing(0.4, t)),
                                 Vec3(0.1 * swing(0.3, t), 0.2 * swing(0.2, t), 0.08));
                   },
                   still});
    return all;
}

} // namespace

int bench_motions(std::vector<BenchRow> &rows) {
    print_header(
        "hand motions: error of force (N) and moment (N m) against a proxy without a game");
    for (const Motion &motion : motions()) {
        run_ideal(motion, rows);
        for (const int frames_hz : kFrameRates_hz) {
            run<OldWay>("planes of the game", motion, frames_hz, rows);
            run<NewWay>("real shapes", motion, frames_hz, rows);
        }
    }
    return 0;
}

} // namespace spidar::bench
