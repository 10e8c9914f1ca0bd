// Lists of the fields of shape and tool descriptions, except points, indices, heights and the shape
// of a tool.
#pragma once

#include <type_traits>

#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/tool_shape.h"
#include "device/recording/codec/field_words.h"

namespace spidar {

// A failing assertion means that a struct changed: add the field below, then correct the number.
static_assert(count_members<ShapeDescription>() == 14, "ShapeDescription changed: list it here");
static_assert(count_members<ToolDescription>() == 5, "ToolDescription changed: list it here");

// Visits the fields of a shape description that are not lists.
template <typename Shape, typename Visit>
void for_each_field(Shape &shape, Visit &&visit) requires
    std::is_same_v<std::remove_const_t<Shape>, ShapeDescription> {
    visit("kind", 0, shape.kind);
    visit_vector("half_extents_m", 0, shape.half_extents_m, visit);
    visit("radius_m", 0, shape.radius_m);
    visit("half_height_m", 0, shape.half_height_m);
    visit("two_sided", 0, shape.two_sided);
    visit("columns", 0, shape.columns);
    visit("rows", 0, shape.rows);
    visit("spacing_x_m", 0, shape.spacing_x_m);
    visit("spacing_z_m", 0, shape.spacing_z_m);
    visit_vector("normal", 0, shape.normal, visit);
    visit("offset_m", 0, shape.offset_m);
}

template <typename Tool, typename Visit>
void for_each_field(
    Tool &tool, Visit &&visit) requires std::is_same_v<std::remove_const_t<Tool>, ToolDescription> {
    visit("kind", 0, tool.kind);
    visit("radius_m", 0, tool.radius_m);
    visit("half_thickness_m", 0, tool.half_thickness_m);
    visit("skin_m", 0, tool.skin_m);
}

} // namespace spidar
