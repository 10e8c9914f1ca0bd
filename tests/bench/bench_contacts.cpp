#include "bench/bench_contacts.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "bench/contact_peers.h"
#include "bench/repeated_times.h"
#include "bench/wavy_field.h"
#include "device/contact/shapes/closest_points.h"
#include "device/contact/shapes/shape_data.h"
#include "support/case_random.h"

namespace spidar::bench {

namespace {

using test::CaseRandom;

constexpr std::size_t kPairs = 4000;
constexpr std::uint64_t kSeed = 5;
constexpr double kSkin_m = 1e-3;
constexpr double kMargin_m = 4e-3;
constexpr double kFailure_m = 1e-4;   // farther off than this, an answer is wrong
constexpr double kBoxHalf_m = 0.1;    // of the block that is touched
constexpr double kFloorHalf_m = 20.0; // of a floor, as a game may have it

// The tool and the shape as the peers know them, and the skin that is taken from their distances.
struct PeerShape {
    int kind = 0;
    Vec3 size{0.0};
    std::vector<Vec3> points;
    std::vector<unsigned> indices;
};

struct Pair {
    Placement tool_at;
    Placement shape_at;
    double gap_m = 0.0;
    Vec3 normal{0.0};
};

struct Set {
    const char *name;
    std::shared_ptr<const ToolShape> tool;
    std::shared_ptr<const CookedShape> shape;
    PeerShape peer_tool;
    PeerShape peer_shape;
    double skin_m = 0.0;
    std::vector<Pair> pairs;
};

std::shared_ptr<const CookedShape> cooked(ShapeDescription description) {
    return cook(std::move(description)).shape;
}

std::shared_ptr<const CookedShape> box(const Vec3 &half) {
    ShapeDescription shape;
    shape.half_extents_m = half;
    return cooked(shape);
}

// --- Pairs whose answer is known -------------------------------------------------------------------

// Over the middle of the block's top, in any posture: the nearest is the core's lowest point, at the height chosen.
Pair over_block(const ToolShape &tool, double half_m, CaseRandom &random) {
    Placement tool_at;
    tool_at.rotation = random.rotation(3.0);
    const Vec3 down = glm::transpose(tool_at.rotation) * Vec3(0.0, -1.0, 0.0);
    const Vec3 lowest = tool_at.rotation * support(view_of(tool.data().core), down);
    const double gap = random.between(0.0, kMargin_m);
    tool_at.origin_m = Vec3(random.between(-0.05, 0.05), half_m + gap + tool.skin_m() - lowest.y,
                            random.between(-0.05, 0.05));
    const Placement block_at{random.vector(0.1), random.rotation(3.0)};
    return {block_at * tool_at, block_at, gap, block_at.rotation[1]};
}

Pair beside_ball(double tool_radius, double radius, CaseRandom &random) {
    Pair pair;
    pair.shape_at = {random.vector(0.1), random.rotation(3.0)};
    pair.tool_at.rotation = random.rotation(3.0);
    pair.normal = pair.tool_at.rotation[0];
    pair.gap_m = random.between(0.0, kMargin_m);
    pair.tool_at.origin_m =
        pair.shape_at.origin_m + (tool_radius + radius + pair.gap_m) * pair.normal;
    return pair;
}

// A ball over the field: the nearest of all triangles, each in closed form.
double distance_to_triangle(const Vec3 &p, const Vec3 &a, const Vec3 &b, const Vec3 &c,
                            Vec3 &nearest) {
    const auto on_segment = [&p](const Vec3 &from, const Vec3 &to) {
        const Vec3 along = to - from;
        const double t = glm::dot(p - from, along) / glm::dot(along, along);
        return from + std::fmin(std::fmax(t, 0.0), 1.0) * along;
    };
    const Vec3 area = glm::cross(b - a, c - a);
    const Vec3 foot = p - (glm::dot(p - a, area) / glm::dot(area, area)) * area;
    if (glm::dot(glm::cross(b - a, foot - a), area) >= 0.0 &&
        glm::dot(glm::cross(c - b, foot - b), area) >= 0.0 &&
        glm::dot(glm::cross(a - c, foot - c), area) >= 0.0) {
        nearest = foot;
        return glm::length(p - foot);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3 &point : {on_segment(a, b), on_segment(b, c), on_segment(c, a)}) {
        if (glm::length(p - point) < least) {
            least = glm::length(p - point);
            nearest = point;
        }
    }
    return least;
}

Pair over_field(const ShapeDescription &mesh, double radius, CaseRandom &random) {
    Pair pair;
    const double x = random.between(-0.2, 0.2);
    const double z = random.between(-0.2, 0.2);
    Vec3 &ball = pair.tool_at.origin_m;
    ball = {x, field_height(x, z) + radius + random.between(0.0, kMargin_m - 1e-3), z};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3 &a = mesh.points_m[mesh.indices[i]];
        if (std::abs(a.x - x) > 0.04 || std::abs(a.z - z) > 0.04) {
            continue; // farther than the ball's own height over the field
        }
        Vec3 nearest;
        const double distance = distance_to_triangle(ball, a, mesh.points_m[mesh.indices[i + 1]],
                                                     mesh.points_m[mesh.indices[i + 2]], nearest);
        if (distance < least) {
            least = distance;
            pair.normal = (ball - nearest) / distance;
        }
    }
    pair.gap_m = least - radius;
    return pair;
}

std::vector<Vec3> hull_points() {
    CaseRandom random(kSeed, 1);
    std::vector<Vec3> points;
    for (int i = 0; i < 32; ++i) {
        const Vec3 point = random.vector(1.0);
        points.push_back(0.02 * point / glm::length(point));
    }
    return points;
}

PeerShape core_of(const ToolShape &tool) {
    const ConvexCore &core = tool.data().core;
    switch (core.kind) {
    case CoreKind::point:
        return {0, Vec3(tool.skin_m()), {}, {}};
    case CoreKind::box:
        return {1, core.half_m, {}, {}};
    case CoreKind::cylinder:
        return {2, Vec3(core.radius_m, core.half_height_m, 0.0), {}, {}};
    default:
        return {3, Vec3(0.0), core.points, {}};
    }
}

std::vector<Set> make_sets(std::size_t pairs) {
    const PeerShape block{1, Vec3(kBoxHalf_m), {}, {}};
    const PeerShape floor{1, Vec3(kFloorHalf_m), {}, {}};
    const auto block_shape = box(Vec3(kBoxHalf_m));
    const auto pad = make_pad(0.012, 0.003, kSkin_m).tool;
    const auto bar = make_tool(*box({0.02, 0.01, 0.03}), kSkin_m).tool;
    ShapeDescription points;
    points.kind = ShapeKind::hull;
    points.points_m = hull_points();
    const auto stone = make_tool(*cooked(points), kSkin_m).tool;
    const double radius = 0.012;
    const auto ball = make_sphere(radius).tool;
    ShapeDescription sphere;
    sphere.kind = ShapeKind::sphere;
    sphere.radius_m = 0.03;
    const ShapeDescription mesh = field(100);
    std::vector<Set> sets{
        {"ball, ball", ball, cooked(sphere), core_of(*ball), {0, Vec3(0.03), {}, {}}, 0.0, {}},
        {"ball, box", ball, block_shape, core_of(*ball), block, 0.0, {}},
        {"pad, box", pad, block_shape, core_of(*pad), block, kSkin_m, {}},
        {"pad, box of 40 m", pad, box(Vec3(kFloorHalf_m)), core_of(*pad), floor, kSkin_m, {}},
        {"box, box", bar, block_shape, core_of(*bar), block, kSkin_m, {}},
        {"hull of 32, box", stone, block_shape, core_of(*stone), block, kSkin_m, {}},
        {"ball, mesh of 20,000",
         ball,
         cooked(mesh),
         core_of(*ball),
         {4, Vec3(0.0), mesh.points_m, {mesh.indices.begin(), mesh.indices.end()}},
         0.0,
         {}},
    };
    for (Set &set : sets) {
        CaseRandom random(kSeed, 2);
        for (std::size_t i = 0; i < pairs; ++i) {
            set.pairs.push_back(&set == &sets.front() ? beside_ball(radius, 0.03, random)
                                : &set == &sets.back()
                                    ? over_field(mesh, radius, random)
                                    : over_block(*set.tool, set.peer_shape.size.y, random));
        }
    }
    return sets;
}

// --- One method on one set -------------------------------------------------------------------------

struct Answer {
    double gap_m = -1.0;
    Vec3 normal{0.0};
};

struct Entry {
    Entry(std::string of_name, std::size_t pairs) : name(std::move(of_name)), times(pairs) {}

    void judge(const Answer &answer, const Pair &pair) {
        const double error = std::abs(answer.gap_m - pair.gap_m);
        failures += error <= kFailure_m ? 0 : 1; // NaN too
        worst_m = std::fmax(worst_m, error);
        const double sine = glm::length(glm::cross(answer.normal, pair.normal));
        worst_rad = std::fmax(worst_rad, std::atan2(sine, glm::dot(answer.normal, pair.normal)));
    }

    std::string name;
    RepeatedTimes times;
    double worst_m = 0.0;
    double worst_rad = 0.0;
    long failures = 0;
};

class Ours {
public:
    Answer operator()(const Set &set, const Pair &pair, bool fresh) {
        if (fresh) {
            memory_->forget();
        }
        static_cast<void>(closest_points(*set.tool, pair.tool_at, *set.shape, pair.shape_at,
                                         kMargin_m + 1e-4, *memory_, out_));
        return out_.count > 0 ? Answer{out_.points[0].gap_m, out_.points[0].normal} : Answer{};
    }

private:
    std::unique_ptr<PairMemory> memory_ = std::make_unique<PairMemory>();
    ClosestPoints out_;
};

struct PeerOnSet {
    const ContactPeer *peer = nullptr;
    void *tool = nullptr;
    void *shape = nullptr;
};

void *make_shape(const ContactPeer &peer, const PeerShape &shape) {
    return peer.shape(shape.kind, &shape.size[0],
                      shape.points.empty() ? nullptr : &shape.points[0][0],
                      static_cast<int>(shape.points.size()), shape.indices.data(),
                      static_cast<int>(shape.indices.size() / 3));
}

std::array<double, 12> pose_of(const Placement &at) {
    std::array<double, 12> pose{};
    for (int column = 0; column < 4; ++column) {
        const Vec3 &from = column < 3 ? at.rotation[column] : at.origin_m;
        for (int i = 0; i < 3; ++i) {
            pose[static_cast<std::size_t>(3 * column + i)] = from[i];
        }
    }
    return pose;
}

void report(const Set &set, Entry &entry, std::vector<BenchRow> &rows) {
    for (const bool normal : {false, true}) {
        BenchRow row;
        row.method = entry.name;
        row.set = set.name;
        row.mode = normal ? "normal (rad)" : "gap (m)";
        entry.times.fill(row);
        row.worst_error = normal ? entry.worst_rad : entry.worst_m;
        row.failures = entry.failures;
        print_row(row);
        rows.push_back(row);
    }
}

long run_set(const Set &set, const std::vector<ContactPeer> &peers, std::vector<BenchRow> &rows) {
    std::vector<PeerOnSet> others;
    std::vector<Entry> entries;
    entries.emplace_back("ours", set.pairs.size());
    for (const ContactPeer &peer : peers) {
        const PeerOnSet other{&peer, make_shape(peer, set.peer_tool),
                              make_shape(peer, set.peer_shape)};
        if (other.tool != nullptr && other.shape != nullptr) {
            others.push_back(other);
            entries.emplace_back(peer.name, set.pairs.size());
        }
    }
    Ours ours;
    in_turns(set.pairs.size(), entries.size(), [&](int run, std::size_t method, std::size_t at) {
        const Pair &pair = set.pairs[at];
        const auto tool_pose = pose_of(pair.tool_at);
        const auto shape_pose = pose_of(pair.shape_at);
        Answer answer;
        entries[method].times.time(at, [&] {
            if (method == 0) {
                answer = ours(set, pair, true);
                return;
            }
            const PeerOnSet &other = others[method - 1];
            answer.gap_m = other.peer->distance(other.tool, tool_pose.data(), other.shape,
                                                shape_pose.data(), &answer.normal[0]) -
                           set.skin_m;
        });
        if (run == 0) {
            entries[method].judge(answer, pair);
        }
    });
    for (Entry &entry : entries) {
        report(set, entry, rows);
    }
    return entries[0].failures;
}

// --- A tool that slides over the field, its triangles remembered -----------------------------------

constexpr double kSpeed_m_s = 0.4;

// Errors: against the same question with nothing remembered.
long slide(const char *name, const ToolShape &tool, double half_thickness_m, int cells,
           std::vector<BenchRow> &rows) {
    const auto mesh = cooked(field(cells));
    const std::size_t ticks = limited(kPairs);
    Set set;
    set.name = name;
    Entry entry("ours", ticks);
    const auto memory = std::make_unique<PairMemory>();
    const auto nothing = std::make_unique<PairMemory>();
    for (int run = 0; run < kRuns; ++run) {
        memory->forget();
        for (std::size_t tick = 0; tick < ticks; ++tick) {
            const Placement at = on_field(kSpeed_m_s, kPeriod_s * static_cast<double>(tick),
                                          half_thickness_m + 5e-4);
            ClosestPoints found;
            entry.times.time(tick, [&] {
                static_cast<void>(closest_points(tool, at, *mesh, {}, 1e-3, *memory, found));
            });
            nothing->forget();
            ClosestPoints fresh;
            static_cast<void>(closest_points(tool, at, *mesh, {}, 1e-3, *nothing, fresh));
            const Answer answer{found.points[0].gap_m, found.points[0].normal};
            const Pair exact{{}, {}, fresh.points[0].gap_m, fresh.points[0].normal};
            if (run == 0 && (found.count == 0 || fresh.count == 0)) {
                ++entry.failures;
            } else if (run == 0) {
                entry.judge(answer, exact);
            }
        }
    }
    report(set, entry, rows);
    return entry.failures;
}

long slides(std::vector<BenchRow> &rows) {
    const auto ball = make_sphere(0.012).tool;
    const auto pad = make_pad(0.012, 0.003, 0.003).tool;
    const auto bar = make_tool(*box(Vec3(0.02)), kSkin_m).tool;
    return slide("ball sliding, 20,000", *ball, 0.012, 100, rows) +
           slide("ball sliding, 100,000", *ball, 0.012, 224, rows) +
           slide("pad sliding, 20,000", *pad, 0.003, 100, rows) +
           slide("pad sliding, 100,000", *pad, 0.003, 224, rows) +
           slide("box of 40 mm sliding, 20,000", *bar, 0.02, 100, rows) +
           slide("box of 40 mm sliding, 100,000", *bar, 0.02, 224, rows);
}

} // namespace

int bench_contacts(std::vector<BenchRow> &rows) {
    print_header("closest points on pairs 0 to 4 mm apart (errors in m and rad)");
    const std::vector<ContactPeer> peers = contact_peers();
    long failures = 0;
    for (const Set &set : make_sets(limited(kPairs))) {
        failures += run_set(set, peers, rows);
    }
    failures += slides(rows);
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::bench
