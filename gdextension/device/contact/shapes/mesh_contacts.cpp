// A point of a triangle counts when it is the nearest of its mesh in its own surroundings: one on an edge or a corner
// that a triangle next to it lies nearer than is no contact, so a seam is not felt, whatever the angle there.
#include "device/contact/shapes/mesh_contacts.h"

#include <limits>

#include "device/contact/shapes/face_contacts.h"
#include "device/contact/shapes/gjk.h"
#include "device/contact/shapes/near_triangles.h"

namespace spidar {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Two triangles meet at one point when their distances differ by no more (m). At a distance of 1 cm that is a normal
// within 1e-4 rad.
constexpr double kSamePoint_m = 1e-10;
// Nearer than this (m), the corner of a tool touches the triangle's plane.
constexpr double kTouch_m = 1e-8;
// A flat tool lies on few faces at once; the corners of its contact are looked for on the nearest of them.
constexpr int kMaxWideContacts = 12;
constexpr int kMaxFan = 32;       // triangles round a corner
constexpr double kAlong = 0.9986; // normals within 3 degrees

class MeshContacts {
public:
    MeshContacts(const TriangleSource &source, const ToolShape::Data &tool,
                 const Placement &tool_at, double margin_m, const PairMemory &memory,
                 ContactCandidates &found) noexcept
        : source_(source), tool_(tool), core_(view_of(tool.core)), at_(tool_at),
          limit_m_(margin_m + tool.skin_m), core_reach_m_(reach_of(core_)), memory_(memory),
          found_(found) {}

    void run() noexcept {
        for (int place = 0; place < memory_.count; ++place) {
            look_at(place);
        }
        for (int i = 0; i < hit_count_; ++i) {
            settle(hits_[static_cast<std::size_t>(i)]);
        }
    }

private:
    struct Hit { // nothing is set at first: there are many, and few are used
        int place;
        Vec3 face; // the triangle's normal on the tool's side
        Vec3 on_core;
        Vec3 on_triangle;
        Vec3 normal;
        double distance_m;
        TrianglePart part;
    };

    [[nodiscard]] const NearTriangle &near(int place) const noexcept {
        return memory_.triangles[static_cast<std::size_t>(place)];
    }
    double &distance(int place) noexcept { return distances_[static_cast<std::size_t>(place)]; }

    void look_at(int place) noexcept {
        distance(place) = kInfinite;
        const Corners triangle = source_.corners(near(place).index);
        const Vec3 area = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        double height = glm::dot(at_.origin_m - triangle[0], area);
        if (height < 0.0 && !source_.two_sided()) {
            return; // seen from behind
        }
        const double size = glm::length(area);
        const Vec3 face = std::copysign(1.0 / size, height) * area;
        height = std::abs(height) / size;
        if (height > limit_m_ + core_reach_m_ || too_far(triangle)) {
            return;
        }
        const Vec3 lowest = support_of(-face);
        const double lowest_m = glm::dot(lowest - triangle[0], face);
        if (lowest_m > limit_m_) {
            return;
        }
        const TriangleDistance found = distance_to(triangle, face, near(place).sharp_edges);
        if (found.overlap) {
            add_overlap(place, face, lowest, lowest_m);
            return;
        }
        distance(place) = found.distance_m;
        if (found.distance_m <= limit_m_) {
            if (hit_count_ == kMaxCandidates) {
                found_.note_left_out();
            } else {
                hits_[static_cast<std::size_t>(hit_count_++)] = {place,         face,
                                                                 found.on_core, found.on_triangle,
                                                                 found.normal,  found.distance_m,
                                                                 found.part};
            }
        }
        if (core_.kind != CoreKind::point) {
            add_corners(place, triangle, face);
        }
    }

    // The ball round a triangle, about the middle of its box.
    [[nodiscard]] bool too_far(const Corners &triangle) const noexcept {
        const Vec3 lower = glm::min(glm::min(triangle[0], triangle[1]), triangle[2]);
        const Vec3 upper = glm::max(glm::max(triangle[0], triangle[1]), triangle[2]);
        const Vec3 apart =
            glm::max(glm::max(lower - at_.origin_m, at_.origin_m - upper), Vec3(0.0));
        const double reach = limit_m_ + core_reach_m_;
        return glm::dot(apart, apart) > reach * reach;
    }

    [[nodiscard]] Vec3 support_of(const Vec3 &way) const noexcept {
        return at_.origin_m + at_.rotation * support(core_, glm::transpose(at_.rotation) * way);
    }

    [[nodiscard]] TriangleDistance distance_to(const Corners &triangle, const Vec3 &face,
                                               std::uint8_t sharp_edges) const noexcept {
        if (core_.kind == CoreKind::point) {
            return point_to_triangle(at_.origin_m, triangle);
        }
        if (core_.kind == CoreKind::disc) {
            return disc_to_triangle(at_.origin_m, at_.rotation[1], core_.radius_m, triangle, face,
                                    sharp_edges);
        }
        CoreView other;
        other.kind = CoreKind::points;
        other.points = triangle;
        Vec3 axis = face;
        const CoreDistance apart = core_distance(core_, at_, other, limit_m_, axis);
        TriangleDistance found;
        found.overlap = apart.overlap;
        found.distance_m = apart.beyond ? kInfinite : apart.distance_m;
        found.on_core = apart.on_tool_m;
        found.on_triangle = apart.on_shape_m;
        found.normal = apart.normal;
        if (!apart.beyond && !apart.overlap) {
            found.part = part_of(found.on_triangle, triangle);
        }
        return found;
    }

    // The core passes through the triangle: out of its plane, on the side of the core's middle.
    void add_overlap(int place, const Vec3 &face, const Vec3 &lowest, double lowest_m) noexcept {
        distance(place) = 0.0;
        add(place, lowest, lowest - lowest_m * face, face, true);
    }

    // Corners of the tool's face that stand over the inside of the triangle: what keeps a flat tool flat.
    void add_corners(int place, const Corners &triangle, const Vec3 &face) noexcept {
        if (glm::dot(face, last_face_) < 1.0 - 1e-12) {
            corners_ = face_towards(core_, at_, -face);
            last_face_ = face;
        }
        for (int i = 0; i < corners_.count; ++i) {
            const Vec3 &corner = corners_.corners[static_cast<std::size_t>(i)];
            const double gap = glm::dot(corner - triangle[0], face);
            if (gap > kTouch_m && gap <= limit_m_ && over_triangle(corner, triangle)) {
                add(place, corner, corner - gap * face, face, false);
            }
        }
    }

    void settle(const Hit &hit) noexcept {
        if (hit.part.kind != TrianglePart::inside && a_neighbour_is_nearer(hit)) {
            return;
        }
        add(hit.place, hit.on_core, hit.on_triangle, hit.normal, false);
        if (core_.kind != CoreKind::point && wide_contacts_ < kMaxWideContacts) {
            ++wide_contacts_;
            add_wide(hit);
        }
    }

    // A face on a face or along an edge touches in more than one point.
    void add_wide(const Hit &hit) noexcept {
        const Vec3 normal = hit.normal;
        const Corners triangle = source_.corners(near(hit.place).index);
        CoreFace part;
        if (glm::dot(normal, hit.face) > kAlong) {
            for (const Vec3 &corner : triangle) {
                part.add(corner);
            }
        } else if (hit.part.kind == TrianglePart::edge) {
            part.add(triangle[hit.part.number]);
            part.add(triangle[(hit.part.number + 1U) % 3]);
        } else {
            return;
        }
        const FacePairs pairs = overlap_of(face_towards(core_, at_, -normal), part, normal);
        for (int i = 0; i < pairs.count; ++i) {
            const FacePair &pair = pairs.pairs[static_cast<std::size_t>(i)];
            const double gap = glm::dot(pair.on_tool - pair.on_shape, normal);
            if (gap > kTouch_m && gap <= limit_m_) {
                add(hit.place, pair.on_tool, pair.on_shape, normal, false);
            }
        }
    }

    [[nodiscard]] bool nearer(std::uint16_t other, double than_m) const noexcept {
        return other != kNoTriangle && distances_[other] < than_m - kSamePoint_m;
    }

    [[nodiscard]] bool a_neighbour_is_nearer(const Hit &hit) const noexcept {
        const NearTriangle &mine = near(hit.place);
        const std::size_t number = hit.part.number;
        if (hit.part.kind == TrianglePart::edge) {
            return nearer(mine.neighbour[number], hit.distance_m);
        }
        const std::uint32_t corner = source_.corner_numbers(mine.index)[number];
        // Round the corner by both of its edges: a border stops the one way.
        return nearer_round(hit, corner, number) || nearer_round(hit, corner, (number + 2) % 3);
    }

    [[nodiscard]] bool nearer_round(const Hit &hit, std::uint32_t corner,
                                    std::size_t over_edge) const noexcept {
        auto from = static_cast<std::uint16_t>(hit.place);
        std::uint16_t here = near(hit.place).neighbour[over_edge];
        for (int step = 0; step < kMaxFan && here != kNoTriangle && here != hit.place; ++step) {
            if (nearer(here, hit.distance_m)) {
                return true;
            }
            const NearTriangle &triangle = near(here);
            const auto numbers = source_.corner_numbers(triangle.index);
            std::uint16_t next = kNoTriangle;
            for (std::size_t edge = 0; edge < 3; ++edge) {
                const bool at_corner = numbers[edge] == corner || numbers[(edge + 1) % 3] == corner;
                if (at_corner && triangle.neighbour[edge] != from) {
                    next = triangle.neighbour[edge];
                }
            }
            from = here;
            here = next;
        }
        return false;
    }

    void add(int place, const Vec3 &on_core, const Vec3 &on_triangle, const Vec3 &normal,
             bool core_inside) noexcept {
        found_.add(on_core, tool_.skin_m, on_triangle, 0.0, normal, near(place).index, core_inside);
    }

    const TriangleSource &source_;
    const ToolShape::Data &tool_;
    const CoreView core_;
    const Placement &at_;
    const double limit_m_;
    const double core_reach_m_;
    const PairMemory &memory_;
    ContactCandidates &found_;
    std::array<double, kMaxNearTriangles> distances_;
    std::array<Hit, kMaxCandidates> hits_;
    int hit_count_ = 0;
    int wide_contacts_ = 0;
    CoreFace corners_;
    Vec3 last_face_{0.0};
};

} // namespace

void mesh_contacts(const CookedShape::Data &mesh, const ToolShape::Data &tool,
                   const Placement &tool_at, double margin_m, PairMemory &memory,
                   ContactCandidates &found) noexcept {
    const TriangleSource source(mesh);
    if (!still_near(memory, tool, tool_at, margin_m)) {
        gather_triangles(source, tool, tool_at, margin_m, memory);
    }
    MeshContacts(source, tool, tool_at, margin_m, memory, found).run();
}

} // namespace spidar
