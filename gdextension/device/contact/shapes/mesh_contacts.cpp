// A point of a mesh is a contact when it is the nearest to the tool locally. Inside a triangle that
// is the foot below the tool's lowest point. On an edge or corner the normal must lie between those
// of the adjacent triangles, so that a seam is not felt at any angle.
#include "device/contact/shapes/mesh_contacts.h"

#include "device/contact/shapes/edge_distance.h"
#include "device/contact/shapes/face_contacts.h"
#include "device/contact/shapes/gjk.h"
#include "device/contact/shapes/near_triangles.h"

namespace spidar {

namespace {

// Distance below which the core meets the triangle's plane (unit: m).
constexpr double kTouch_m = 1e-8;
// A foot on the edge of two triangles must be inside one of them: this much outside counts as
// inside (unit: m).
constexpr double kEdge_m = 1e-9;
// Sine by which a normal may lean out of the cone of its edge or corner: rounding, below 0.02
// degrees.
constexpr double kLean = 3e-4;
// Largest number of mesh faces on which the contact corners of a flat tool are searched.
constexpr int kMaxWideContacts = 12;
constexpr int kMaxFan = 32;       // triangles around a corner
constexpr double kAlong = 0.9986; // cosine of 3 degrees between normals

// Result of the first look at a triangle. Bit i: the tool's lowest point over the triangle's plane
// lies beyond edge i. An edge can be nearest to the tool only where this holds for both of its
// triangles.
constexpr std::uint8_t kUnseen = 8; // seen from behind: the other triangle decides alone

class MeshContacts {
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): large, and filled before it is read
    MeshContacts(const TriangleSource &source, const ToolShape::Data &tool,
                 const Placement &tool_at, double margin_m, const PairMemory &memory,
                 ContactCandidates &found) noexcept
        : source_(source), tool_(tool), core_(view_of(tool.core)), at_(tool_at),
          back_(glm::transpose(tool_at.rotation)), limit_m_(margin_m + tool.skin_m),
          core_reach_m_(reach_of(core_)), memory_(memory), found_(found) {
        if (core_.kind == CoreKind::disc || core_.kind == CoreKind::cylinder) {
            rims_[0] = face_towards(core_, at_, at_.rotation[1]);
            rims_[1] = face_towards(core_, at_, -at_.rotation[1]);
            corner_step_ = 2; // four of eight keep a pad flat
        }
    }

    void run() noexcept {
        for (int place = 0; place < memory_.count; ++place) {
            beyond_[static_cast<std::size_t>(place)] = look_at(place);
        }
        for (int place = 0; place < memory_.count; ++place) {
            look_at_edges(place);
        }
    }

private:
    [[nodiscard]] const NearTriangle &near(int place) const noexcept {
        return memory_.triangles[static_cast<std::size_t>(place)];
    }

    [[nodiscard]] Vec3 support_of(const Vec3 &way) const noexcept {
        return at_.origin_m + at_.rotation * support(core_, back_ * way);
    }

    std::uint8_t look_at(int place) noexcept {
        const NearTriangle &known = near(place);
        const Vec3 middle(known.middle_m[0], known.middle_m[1], known.middle_m[2]);
        const double away = distance_to_core(core_, back_ * (middle - at_.origin_m));
        if (away > limit_m_ + static_cast<double>(known.radius_m)) {
            return 0;
        }
        const Corners triangle = source_.corners(near(place).index);
        const Vec3 area = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const double height = glm::dot(at_.origin_m - triangle[0], area);
        if (height < 0.0 && !source_.two_sided()) {
            return kUnseen;
        }
        const double size = glm::length(area);
        if (std::abs(height) > (limit_m_ + core_reach_m_) * size) {
            return 0;
        }
        const Vec3 face = std::copysign(1.0 / size, height) * area;
        const Vec3 lowest = core_.kind == CoreKind::point ? at_.origin_m : support_of(-face);
        const double lowest_m = glm::dot(lowest - triangle[0], face);
        if (lowest_m > limit_m_) {
            return 0;
        }
        if (lowest_m < kTouch_m && meets(triangle)) {
            add(place, lowest, lowest - lowest_m * face, face, true);
            return kUnseen;
        }
        // A core that reaches behind the plane may touch any edge.
        std::uint8_t beyond = lowest_m < kTouch_m ? 7 : 0;
        bool inside = true;
        const double slack = kEdge_m * size;
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const Vec3 along = triangle[(edge + 1) % 3] - triangle[edge];
            const double in = glm::dot(glm::cross(along, lowest - triangle[edge]), area);
            const double edge_slack =
                slack * (std::abs(along.x) + std::abs(along.y) + std::abs(along.z));
            inside = inside && in >= -edge_slack;
            beyond = static_cast<std::uint8_t>(beyond | (in <= edge_slack ? 1U << edge : 0U));
        }
        if (inside && lowest_m >= kTouch_m) {
            add(place, lowest, lowest - lowest_m * face, face, false);
            add_wide(place, triangle, face, triangle_face(triangle));
        }
        if (core_.kind != CoreKind::point) {
            const CoreFace &corners = corners_towards(face);
            add_corners(place, triangle, face, corners);
            add_creases(place, triangle, face, corners);
        }
        return beyond;
    }

    // Returns whether the core passes through the triangle.
    [[nodiscard]] bool meets(const Corners &triangle) const noexcept {
        CoreView other;
        other.kind = CoreKind::points;
        other.points = triangle;
        Vec3 axis = at_.origin_m - (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        return core_distance(core_, at_, other, kTouch_m, axis).overlap;
    }

    void look_at_edges(int place) noexcept {
        const std::uint8_t mine = beyond_[static_cast<std::size_t>(place)];
        if ((mine & kUnseen) != 0) {
            return;
        }
        const NearTriangle &triangle = near(place);
        for (std::size_t edge = 0; edge < 3; ++edge) {
            if ((mine & triangle.sharp_edges & (1U << edge)) == 0) {
                continue;
            }
            const std::uint16_t other = triangle.neighbour[edge];
            if (other != kNoTriangle && (beyond_[other] & kUnseen) == 0) {
                const auto &back = near(other).neighbour;
                const std::size_t its = back[0] == place ? 0 : back[1] == place ? 1 : 2;
                if (other < place || (beyond_[other] & (1U << its)) == 0) {
                    continue;
                }
            }
            touch_edge(place, edge);
        }
    }

    void touch_edge(int place, std::size_t edge) noexcept {
        const std::uint32_t number = near(place).index;
        const Corners triangle = source_.corners(number);
        const Vec3 &from = triangle[edge];
        const Vec3 &to = triangle[(edge + 1) % 3];
        const EdgeDistance at = edge_distance(core_, at_, from, to, limit_m_);
        if (at.beyond) {
            return;
        }
        if (at.overlap) {
            const Vec3 up = normal_of(triangle);
            const Vec3 face = glm::dot(at_.origin_m - from, up) < 0.0 ? -up : up;
            const Vec3 lowest = support_of(-face);
            add(place, lowest, lowest - std::fmin(glm::dot(lowest - from, face), 0.0) * face, face,
                true);
            return;
        }
        const auto corners = source_.corner_numbers(number);
        if (at.end != EdgeDistance::inner) {
            const std::size_t corner = at.end == EdgeDistance::from ? edge : (edge + 1) % 3;
            if (!corner_holds(number, corners[corner], corner, triangle[corner], at.normal)) {
                return;
            }
        } else if (!side_holds(triangle[(edge + 2) % 3], from, to, at.normal) ||
                   !other_side_holds(number, edge, from, to, at.normal)) {
            return;
        }
        if (!source_.two_sided() && !in_front(number, at.normal) &&
            !in_front(source_.neighbour(number, edge), at.normal)) {
            return; // below the border of an open mesh
        }
        add(place, at.on_core, at.on_edge, at.normal, false);
        if (at.end == EdgeDistance::inner || core_.kind != CoreKind::disc) {
            CoreFace part;
            part.add(from);
            part.add(to);
            add_wide(place, triangle, at.normal, part);
        }
    }

    [[nodiscard]] bool in_front(std::uint32_t triangle, const Vec3 &normal) const noexcept {
        return triangle != kNone && glm::dot(normal_of(source_.corners(triangle)), normal) > -kLean;
    }

    // Requires that the triangle leads away from the edge, as seen along the normal.
    [[nodiscard]] static bool side_holds(const Vec3 &third, const Vec3 &from, const Vec3 &to,
                                         const Vec3 &normal) noexcept {
        const Vec3 along = to - from;
        const Vec3 side = third - from;
        const Vec3 across = side - (glm::dot(side, along) / glm::dot(along, along)) * along;
        return glm::dot(normal, across) <= kLean * glm::length(across);
    }

    [[nodiscard]] bool other_side_holds(std::uint32_t triangle, std::size_t edge, const Vec3 &from,
                                        const Vec3 &to, const Vec3 &normal) const noexcept {
        const std::uint32_t other = source_.neighbour(triangle, edge);
        if (other == kNone) {
            return true;
        }
        const auto mine = source_.corner_numbers(triangle);
        const auto its = source_.corner_numbers(other);
        const Corners corners = source_.corners(other);
        for (std::size_t i = 0; i < 3; ++i) {
            if (its[i] != mine[edge] && its[i] != mine[(edge + 1) % 3]) {
                return side_holds(corners[i], from, to, normal);
            }
        }
        return true;
    }

    // Requires that every edge leads away from the corner, as seen along the normal. Walks both
    // ways around, since a border stops one.
    [[nodiscard]] bool corner_holds(std::uint32_t triangle, std::uint32_t corner, std::size_t place,
                                    const Vec3 &at, const Vec3 &normal) const noexcept {
        return fan_holds(triangle, corner, place, at, normal) &&
               fan_holds(triangle, corner, (place + 2) % 3, at, normal);
    }

    [[nodiscard]] bool fan_holds(std::uint32_t first, std::uint32_t corner, std::size_t over_edge,
                                 const Vec3 &at, const Vec3 &normal) const noexcept {
        std::uint32_t from = first;
        std::uint32_t here = source_.neighbour(first, over_edge);
        bool holds = leads_away(first, corner, at, normal);
        for (int step = 0; step < kMaxFan && holds && here != kNone && here != first; ++step) {
            holds = leads_away(here, corner, at, normal);
            const auto numbers = source_.corner_numbers(here);
            std::uint32_t next = kNone;
            for (std::size_t edge = 0; edge < 3; ++edge) {
                const bool at_corner = numbers[edge] == corner || numbers[(edge + 1) % 3] == corner;
                const std::uint32_t over = at_corner ? source_.neighbour(here, edge) : kNone;
                if (over != kNone && over != from) {
                    next = over;
                }
            }
            from = here;
            here = next;
        }
        return holds;
    }

    [[nodiscard]] bool leads_away(std::uint32_t triangle, std::uint32_t corner, const Vec3 &at,
                                  const Vec3 &normal) const noexcept {
        const auto numbers = source_.corner_numbers(triangle);
        const Corners corners = source_.corners(triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 edge = corners[i] - at;
            if (numbers[i] != corner && glm::dot(edge, normal) > kLean * glm::length(edge)) {
                return false;
            }
        }
        return true;
    }

    // Corners of the tool's face over the inside of the triangle keep a flat tool flat.
    void add_corners(int place, const Corners &triangle, const Vec3 &face,
                     const CoreFace &corners) noexcept {
        const Vec3 lower =
            glm::min(glm::min(triangle[0], triangle[1]), triangle[2]) - Vec3(kEdge_m);
        const Vec3 upper =
            glm::max(glm::max(triangle[0], triangle[1]), triangle[2]) + Vec3(kEdge_m);
        for (int i = 0; i < corners.count; i += corner_step_) {
            const Vec3 &corner = corners.corners[static_cast<std::size_t>(i)];
            const double gap = glm::dot(corner - triangle[0], face);
            if (gap < kTouch_m || gap > limit_m_) {
                continue;
            }
            const Vec3 foot = corner - gap * face;
            const bool in_box = foot.x >= lower.x && foot.x <= upper.x && foot.y >= lower.y &&
                                foot.y <= upper.y && foot.z >= lower.z && foot.z <= upper.z;
            if (in_box && over_triangle(corner, triangle)) {
                add(place, corner, foot, face, false);
            }
        }
    }

    // Edges of a mesh face, where they cross the tool's face, keep a large tool flat on a small
    // block.
    void add_creases(int place, const Corners &triangle, const Vec3 &face,
                     const CoreFace &corners) noexcept {
        const std::uint8_t creases = near(place).sharp_edges >> 4U;
        if (creases == 0 || corners.count < 3) {
            return;
        }
        for (std::size_t edge = 0; edge < 3; ++edge) {
            if ((creases & (1U << edge)) != 0) {
                CoreFace part;
                part.add(triangle[edge]);
                part.add(triangle[(edge + 1) % 3]);
                add_pairs(place, overlap_of(corners, part, face), face);
            }
        }
    }

    [[nodiscard]] const CoreFace &corners_towards(const Vec3 &face) noexcept {
        if (core_.kind == CoreKind::disc || core_.kind == CoreKind::cylinder) {
            return rims_[glm::dot(at_.rotation[1], face) > 0.0 ? 1 : 0];
        }
        if (glm::dot(face, last_face_) < 1.0 - 1e-12) {
            corners_ = face_towards(core_, at_, -face);
            last_face_ = face;
        }
        return corners_;
    }

    [[nodiscard]] static CoreFace triangle_face(const Corners &triangle) noexcept {
        CoreFace face;
        for (const Vec3 &corner : triangle) {
            face.add(corner);
        }
        return face;
    }

    // A face on a face or along an edge touches in several points.
    void add_wide(int place, const Corners &triangle, const Vec3 &normal,
                  const CoreFace &part) noexcept {
        if (core_.kind == CoreKind::point || wide_contacts_ == kMaxWideContacts) {
            return;
        }
        ++wide_contacts_;
        const bool flat = std::abs(glm::dot(normal, normal_of(triangle))) > kAlong;
        add_pairs(place,
                  overlap_of(face_towards(core_, at_, -normal),
                             flat ? triangle_face(triangle) : part, normal),
                  normal);
    }

    void add_pairs(int place, const FacePairs &pairs, const Vec3 &normal) noexcept {
        for (int i = 0; i < pairs.count; ++i) {
            const FacePair &pair = pairs.pairs[static_cast<std::size_t>(i)];
            const double gap = glm::dot(pair.on_tool - pair.on_shape, normal);
            if (gap > kTouch_m && gap <= limit_m_) {
                add(place, pair.on_tool, pair.on_shape, normal, false);
            }
        }
    }

    void add(int place, const Vec3 &on_core, const Vec3 &on_triangle, const Vec3 &normal,
             bool core_inside) noexcept {
        found_.add(on_core, tool_.skin_m, on_triangle, 0.0, normal, near(place).index, core_inside);
    }

    const TriangleSource &source_;
    const ToolShape::Data &tool_;
    const CoreView core_;
    const Placement &at_;
    const Mat3 back_;
    const double limit_m_;
    const double core_reach_m_;
    const PairMemory &memory_;
    ContactCandidates &found_;
    std::array<std::uint8_t, kMaxNearTriangles> beyond_;
    int wide_contacts_ = 0;
    int corner_step_ = 1;
    std::array<CoreFace, 2> rims_; // towards the axis of a round core, and against it
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
