#include "device/contact/shapes/closest_points.h"

#include <algorithm>

#include "device/contact/shapes/contact_choice.h"
#include "device/contact/shapes/face_contacts.h"
#include "device/contact/shapes/gjk.h"
#include "device/contact/shapes/mesh_contacts.h"
#include "device/contact/shapes/overlap.h"
#include "device/contact/shapes/shape_data.h"

namespace spidar {

namespace {

// Points on the tool nearer to each other than this (unit: m) count as one, since they would push
// as one.
constexpr double kSpacing_m = 1e-3;

Placement relative(const Placement &tool_at, const Placement &shape_at) noexcept {
    const Mat3 back = glm::transpose(shape_at.rotation);
    return {back * (tool_at.origin_m - shape_at.origin_m), back * tool_at.rotation};
}

// An infinite plane: every corner of the tool has an exact distance on both sides.
void half_space_contacts(const ShapeDescription &wall, const ToolShape::Data &tool,
                         const Placement &tool_at, double margin_m,
                         ContactCandidates &found) noexcept {
    const CoreView core = view_of(tool.core);
    CoreFace corners = face_towards(core, tool_at, -wall.normal);
    corners.add(tool_at.origin_m +
                tool_at.rotation * support(core, glm::transpose(tool_at.rotation) * -wall.normal));
    for (int i = 0; i < corners.count; ++i) {
        const Vec3 &corner = corners.corners[static_cast<std::size_t>(i)];
        const double height = glm::dot(wall.normal, corner) - wall.offset_m;
        if (height - tool.skin_m > margin_m) {
            continue;
        }
        found.add(corner, tool.skin_m, corner - height * wall.normal, 0.0, wall.normal, 0,
                  height < 0.0);
    }
}

class ConvexContacts {
public:
    ConvexContacts(const CookedShape::Data &shape, const ToolShape::Data &tool,
                   const Placement &tool_at, double margin_m, ContactCandidates &found) noexcept
        : shape_(shape), tool_(tool), at_(tool_at), margin_m_(margin_m), found_(found) {}

    void run(Vec3 &axis) noexcept {
        const CoreView tool_core = view_of(tool_.core);
        const CoreView shape_core = view_of(shape_.core);
        const double limit = margin_m_ + tool_.skin_m + shape_.skin_m;
        CoreDistance nearest = core_distance(tool_core, at_, shape_core, limit, axis);
        if (nearest.beyond) {
            return;
        }
        if (nearest.overlap) {
            nearest = way_out(tool_core, at_, shape_core);
            axis = nearest.normal;
        }
        const Vec3 normal = nearest.normal;
        const CoreFace tool_face = face_towards(tool_core, at_, -normal);
        const CoreFace shape_face = face_towards(shape_core, normal);
        face_ = shape_face.number;
        add(nearest.on_tool_m, nearest.on_shape_m, normal, nearest.overlap);
        const FacePairs pairs = overlap_of(tool_face, shape_face, normal);
        for (int i = 0; i < pairs.count; ++i) {
            const FacePair &pair = pairs.pairs[static_cast<std::size_t>(i)];
            add(pair.on_tool, pair.on_shape, normal, nearest.overlap);
        }
    }

private:
    void add(const Vec3 &on_tool, const Vec3 &on_shape, const Vec3 &normal,
             bool core_inside) noexcept {
        const double apart = glm::dot(on_tool - on_shape, normal);
        if (apart - tool_.skin_m - shape_.skin_m <= margin_m_) {
            found_.add(on_tool, tool_.skin_m, on_shape, shape_.skin_m, normal, face_, core_inside);
        }
    }

    const CookedShape::Data &shape_;
    const ToolShape::Data &tool_;
    const Placement &at_;
    const double margin_m_;
    ContactCandidates &found_;
    std::uint32_t face_ = 0;
};

} // namespace

bool is_far(const ToolShape &tool, const Vec3 &tool_m, const CookedShape &shape,
            double margin_m) noexcept {
    const Vec3 apart_m =
        glm::max(glm::max(shape.lower_m() - tool_m, tool_m - shape.upper_m()), Vec3(0.0));
    const double reach_m = tool.reach_m() + margin_m;
    return glm::dot(apart_m, apart_m) > reach_m * reach_m;
}

Status closest_points(const ToolShape &tool, const Placement &tool_at, const CookedShape &shape,
                      const Placement &shape_at, double margin_m, PairMemory &memory,
                      ClosestPoints &out) noexcept {
    out.count = 0;
    out.left_out = false;
    if (!all_finite(tool_at) || !all_finite(shape_at) || !std::isfinite(margin_m)) {
        return Status::not_finite;
    }
    const ToolShape::Data &tool_data = tool.data();
    const CookedShape::Data &shape_data = shape.data();
    const Placement at = relative(tool_at, shape_at);
    if (is_far(tool, at.origin_m, shape, margin_m)) {
        return Status::ok;
    }
    ContactCandidates found;
    if (shape.kind() == ShapeKind::half_space) {
        half_space_contacts(shape_data.description, tool_data, at, margin_m, found);
    } else if (shape.convex()) {
        ConvexContacts(shape_data, tool_data, at, margin_m, found).run(memory.axis);
    } else {
        mesh_contacts(shape_data, tool_data, at, margin_m, memory, found);
        out.left_out = memory.full;
    }
    found.choose(shape_at, kSpacing_m, out);
    return Status::ok;
}

} // namespace spidar
