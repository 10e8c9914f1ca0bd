#include "device/contact/shapes/tool_shape.h"

#include <algorithm>

#include "core/base/finite.h"
#include "device/contact/shapes/hull_builder.h"
#include "device/contact/shapes/shape_data.h"

namespace spidar {

namespace {

ToolResult refuse(const char *sentence) {
    ToolResult result;
    result.status = Status::invalid_shape;
    result.sentence = sentence;
    return result;
}

ToolResult finish(std::unique_ptr<ToolShape::Data> data) {
    data->reach_m = reach_of(view_of(data->core)) + data->skin_m;
    ToolResult result;
    result.tool = std::make_shared<const ToolShape>(std::move(data));
    return result;
}

// A skin takes at most half of the shape's thickness.
double skin_for(double wanted_m, double half_thickness_m) {
    return std::min(wanted_m, 0.5 * half_thickness_m);
}

} // namespace

ToolShape::ToolShape(std::unique_ptr<const Data> data)
    : data_(std::move(data)), number_(new_shape_number()) {}
ToolShape::~ToolShape() = default;

const ToolDescription &ToolShape::description() const noexcept {
    return data_->description;
}

double ToolShape::skin_m() const noexcept {
    return data_->skin_m;
}

double ToolShape::reach_m() const noexcept {
    return data_->reach_m;
}

ToolResult make_pad(double radius_m, double half_thickness_m, double skin_m) {
    if (!positive_finite(radius_m) || !positive_finite(half_thickness_m) ||
        !positive_finite(skin_m)) {
        return refuse("A pad needs a radius, a half thickness and a skin above 0.");
    }
    if (skin_m > half_thickness_m || skin_m >= radius_m) {
        return refuse("The skin of a pad is thicker than the pad; set skin_m to at most "
                      "half_thickness_m and below radius_m.");
    }
    auto data = std::make_unique<ToolShape::Data>();
    data->description = {ToolKind::pad, radius_m, half_thickness_m, skin_m, {}};
    const double half_height = half_thickness_m - skin_m;
    data->core.kind = half_height > 0.0 ? CoreKind::cylinder : CoreKind::disc;
    data->core.radius_m = radius_m - skin_m;
    data->core.half_height_m = half_height;
    data->skin_m = skin_m;
    return finish(std::move(data));
}

ToolResult make_sphere(double radius_m) {
    if (!positive_finite(radius_m)) {
        return refuse("A sphere needs a radius above 0.");
    }
    auto data = std::make_unique<ToolShape::Data>();
    data->description.kind = ToolKind::sphere;
    data->description.radius_m = radius_m;
    data->skin_m = radius_m;
    return finish(std::move(data));
}

ToolResult make_tool(const CookedShape &shape, double skin_m) {
    if (!positive_finite(skin_m)) {
        return refuse("A tool needs a skin above 0.");
    }
    if (!shape.convex() || shape.kind() == ShapeKind::half_space) {
        return refuse(
            "A mesh, a height map, a half space or a relief cannot be a tool; give a convex hull.");
    }
    const CookedShape::Data &from = shape.data();
    auto data = std::make_unique<ToolShape::Data>();
    data->description.kind = ToolKind::shape;
    data->description.skin_m = skin_m;
    data->description.shape = from.description;
    data->core = from.core;
    switch (from.core.kind) {
    case CoreKind::point:
    case CoreKind::segment:
        data->skin_m = from.skin_m; // round already
        break;
    case CoreKind::box:
        data->skin_m = skin_for(
            skin_m, std::min({from.core.half_m.x, from.core.half_m.y, from.core.half_m.z}));
        data->core.half_m -= Vec3(data->skin_m);
        break;
    case CoreKind::disc:
    case CoreKind::cylinder:
        data->skin_m = skin_for(skin_m, std::min(from.core.radius_m, from.core.half_height_m));
        data->core.radius_m -= data->skin_m;
        data->core.half_height_m -= data->skin_m;
        break;
    case CoreKind::points:
        data->skin_m = skin_m;
        if (!shrink_hull(from.core, data->skin_m, data->core)) {
            return refuse("The hull is too thin or too uneven for a skin; use a box instead.");
        }
        break;
    }
    return finish(std::move(data));
}

ToolResult make_tool(const ToolDescription &description) {
    switch (description.kind) {
    case ToolKind::pad:
        return make_pad(description.radius_m, description.half_thickness_m, description.skin_m);
    case ToolKind::sphere:
        return make_sphere(description.radius_m);
    case ToolKind::shape: {
        CookResult cooked = cook(description.shape);
        if (usable(cooked.status)) {
            return make_tool(*cooked.shape, description.skin_m);
        }
        ToolResult result;
        result.status = cooked.status;
        result.sentence = std::move(cooked.sentence);
        return result;
    }
    }
    return refuse("This kind of tool is unknown.");
}

} // namespace spidar
