#include "godot/hand/scene/shape_data.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/plane.hpp>
#include <godot_cpp/variant/string.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/scene/engine_habits.h"
#include "godot/hand/scene/hull_points.h"

namespace spidar {

namespace {

using godot::PhysicsServer3D;
using godot::Variant;

constexpr std::int64_t kMostPointsAtOnce = 1500; // 500 triangles, half a millisecond
constexpr std::int64_t kMostHullPointsAtOnce = 300;
// Largest number of hull points; of more the outermost are used. It is what cook() accepts, and the
// time grows with its square.
constexpr std::size_t kMostHullPoints = 4096;
constexpr std::int64_t kMostHeightsAtOnce = 65536;

double number(const godot::Dictionary &data, const Variant &key) {
    return static_cast<double>(data[key]);
}

bool take_points(const Variant &value, ShapeData &data) {
    if (value.get_type() != Variant::PACKED_VECTOR3_ARRAY) {
        return false;
    }
    data.points = godot::PackedVector3Array(value);
    data.numbers.point_count = data.points.size();
    data.numbers.points = data.numbers.point_count > 0 ? data.points.ptr() : nullptr;
    return true;
}

template <class T>
bool same_elements(const T *a, const T *b, std::int64_t count) {
    return a == b ||
           (count > 0 && std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(T)) == 0);
}

// Returns the corners of a mirrored height map, which a cooked height map cannot represent.
ShapeDescription mesh_of_heights(const ShapeNumbers &map, const Vec3 &scale) {
    ShapeDescription mesh;
    mesh.kind = ShapeKind::mesh;
    mesh.two_sided = true;
    const auto columns = static_cast<std::uint32_t>(map.width);
    const auto rows = static_cast<std::uint32_t>(map.depth);
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const auto height = static_cast<double>(map.heights[row * columns + column]);
            const Vec3 point(column - 0.5 * (columns - 1), std::isfinite(height) ? height : 0.0,
                             row - 0.5 * (rows - 1));
            mesh.points_m.push_back(scale * point);
        }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (!std::isnan(map.heights[a] + map.heights[b] + map.heights[c])) {
            mesh.indices.insert(mesh.indices.end(), {a, c, b}); // turned over by the mirror
        }
    };
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const std::uint32_t corner = row * columns + column;
            add(corner, corner + columns, corner + 1);
            add(corner + 1, corner + columns, corner + columns + 1);
        }
    }
    return mesh;
}

ShapeDescription describe_heights(const ShapeNumbers &map, const Vec3 &scale) {
    if (map.height_count != static_cast<std::int64_t>(map.width) * map.depth) {
        ShapeDescription refused; // cook() says what is wrong
        refused.kind = ShapeKind::height_map;
        return refused;
    }
    if (scale.x < 0.0) {
        return mesh_of_heights(map, scale);
    }
    ShapeDescription result;
    result.kind = ShapeKind::height_map;
    result.two_sided = true; // as in the engine's physics
    result.columns = map.width;
    result.rows = map.depth;
    result.spacing_x_m = scale.x;
    result.spacing_z_m = scale.z;
    result.heights_m.resize(static_cast<std::size_t>(map.height_count));
    constexpr float kHole = std::numeric_limits<float>::max(); // a second mark of a hole
    std::transform(map.heights, map.heights + map.height_count, result.heights_m.begin(),
                   [&scale](float height) {
                       return height == kHole
                                  ? std::numeric_limits<float>::quiet_NaN()
                                  : static_cast<float>(scale.y * static_cast<double>(height));
                   });
    return result;
}

ShapeDescription describe_points(const ShapeNumbers &shape, const Vec3 &scale) {
    ShapeDescription result;
    const bool mesh = shape.type == PhysicsServer3D::SHAPE_CONCAVE_POLYGON;
    result.kind = mesh ? ShapeKind::mesh : ShapeKind::hull;
    result.two_sided = shape.two_sided;
    result.points_m.resize(static_cast<std::size_t>(shape.point_count));
    std::transform(shape.points, shape.points + shape.point_count, result.points_m.begin(),
                   [&scale](const godot::Vector3 &point) { return scale * to_core(point); });
    if (mesh) {
        // Clockwise in the engine, counter-clockwise here; a mirror reverses the order once more.
        const std::uint32_t second = scale.x < 0.0 ? 1 : 2;
        const auto corners = static_cast<std::uint32_t>(shape.point_count);
        result.indices.reserve(corners);
        for (std::uint32_t first = 0; first + 2 < corners; first += 3) {
            result.indices.insert(result.indices.end(),
                                  {first, first + second, first + 3 - second});
        }
    }
    return result;
}

bool is_uneven(const ShapeNumbers &shape, const Vec3 &scale) noexcept {
    constexpr double kEven = 1e-3;
    const Vec3 size = glm::abs(scale);
    const double across = std::abs(size.x - size.z);
    const double along = std::max(std::abs(size.y - size.x), std::abs(size.y - size.z));
    switch (shape.type) {
    case PhysicsServer3D::SHAPE_SPHERE:
    case PhysicsServer3D::SHAPE_CAPSULE:
        return std::max(across, along) > kEven * size.y;
    case PhysicsServer3D::SHAPE_CYLINDER:
        return across > kEven * size.x;
    default:
        return false;
    }
}

// Returns the hull of a round shape with uneven scale.
ShapeDescription stretched(const ShapeNumbers &shape, const Vec3 &scale) {
    ShapeDescription hull;
    hull.kind = ShapeKind::hull;
    const double straight =
        shape.type == PhysicsServer3D::SHAPE_CAPSULE ? 0.5 * shape.height - shape.radius : 0.0;
    hull.points_m = shape.type == PhysicsServer3D::SHAPE_CYLINDER
                        ? rim_points(shape.radius, 0.5 * shape.height)
                        : round_points(shape.radius, std::max(straight, 0.0));
    for (Vec3 &point : hull.points_m) {
        point *= scale;
    }
    return hull;
}

} // namespace

ShapeReader::ShapeReader()
    : radius_("radius"), height_("height"), faces_("faces"),
      backface_collision_("backface_collision"), heights_("heights"), width_("width"),
      depth_("depth") {}

ShapeData ShapeReader::take(const godot::RID &shape) const {
    auto *server = PhysicsServer3D::get_singleton();
    ShapeData data;
    ShapeNumbers &numbers = data.numbers;
    numbers.type = server->shape_get_type(shape);
    numbers.evened = engine_habits().evens_round_shapes;
    const Variant value = server->shape_get_data(shape);
    const bool parts = value.get_type() == Variant::DICTIONARY;
    switch (numbers.type) {
    case PhysicsServer3D::SHAPE_SPHERE:
        numbers.radius = static_cast<double>(value);
        data.readable = true;
        break;
    case PhysicsServer3D::SHAPE_BOX:
        numbers.half_extents = to_core(godot::Vector3(value));
        data.readable = true;
        break;
    case PhysicsServer3D::SHAPE_CAPSULE:
    case PhysicsServer3D::SHAPE_CYLINDER:
        if (parts) {
            const godot::Dictionary sizes(value);
            numbers.radius = number(sizes, radius_);
            numbers.height = number(sizes, height_);
        }
        data.readable = parts;
        break;
    case PhysicsServer3D::SHAPE_CONVEX_POLYGON:
        data.readable = take_points(value, data);
        break;
    case PhysicsServer3D::SHAPE_CONCAVE_POLYGON:
        if (parts) {
            const godot::Dictionary mesh(value);
            data.readable = take_points(mesh[faces_], data);
            numbers.two_sided = mesh[backface_collision_].booleanize();
        }
        break;
    case PhysicsServer3D::SHAPE_HEIGHTMAP:
        if (parts) {
            const godot::Dictionary map(value);
            const Variant &heights = map[heights_];
            if (heights.get_type() == Variant::PACKED_FLOAT32_ARRAY) {
                data.heights = godot::PackedFloat32Array(heights);
                numbers.height_count = data.heights.size();
                numbers.heights = numbers.height_count > 0 ? data.heights.ptr() : nullptr;
                data.readable = true;
            }
            numbers.width = static_cast<int>(number(map, width_));
            numbers.depth = static_cast<int>(number(map, depth_));
        }
        break;
    case PhysicsServer3D::SHAPE_WORLD_BOUNDARY: {
        const godot::Plane plane(value);
        numbers.normal = to_core(plane.normal);
        numbers.offset = static_cast<double>(engine_habits().turns_boundaries ? -plane.d : plane.d);
        data.readable = true;
        break;
    }
    default:
        break;
    }
    return data;
}

ShapeData ShapeReader::read(const godot::RID &shape) const {
    ShapeData data = take(shape);
    if (!is_large(data.numbers)) {
        data.bounds = bounds_of(data.numbers);
    }
    return data;
}

DataChange ShapeReader::read_again(const godot::RID &shape, ShapeData &data) const {
    ShapeData newest = take(shape);
    const ShapeNumbers &a = data.numbers;
    const ShapeNumbers &b = newest.numbers;
    const bool same_counts = a.point_count == b.point_count && a.height_count == b.height_count &&
                             a.width == b.width && a.depth == b.depth;
    const bool same_sizes = a.type == b.type && a.radius == b.radius && a.height == b.height &&
                            a.half_extents == b.half_extents && a.normal == b.normal &&
                            a.offset == b.offset && a.two_sided == b.two_sided;
    if (same_counts && same_sizes && same_elements(a.points, b.points, a.point_count) &&
        same_elements(a.heights, b.heights, a.height_count)) {
        const bool copied = a.points != b.points || a.heights != b.heights;
        return copied ? DataChange::copied : DataChange::none;
    }
    if (!is_large(newest.numbers)) {
        newest.bounds = bounds_of(newest.numbers);
    }
    data = std::move(newest);
    return DataChange::changed;
}

ShapeBounds bounds_of(const ShapeNumbers &shape) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    ShapeBounds box;
    switch (shape.type) {
    case PhysicsServer3D::SHAPE_SPHERE:
        box.upper = Vec3(shape.radius);
        break;
    case PhysicsServer3D::SHAPE_BOX:
        box.upper = shape.half_extents;
        break;
    case PhysicsServer3D::SHAPE_CAPSULE:
    case PhysicsServer3D::SHAPE_CYLINDER:
        box.upper = {shape.radius, std::max(0.5 * shape.height, 0.0), shape.radius};
        break;
    case PhysicsServer3D::SHAPE_CONVEX_POLYGON:
    case PhysicsServer3D::SHAPE_CONCAVE_POLYGON:
        box = {Vec3(kInfinite), Vec3(-kInfinite)};
        for (std::int64_t i = 0; i < shape.point_count; ++i) {
            const Vec3 point = to_core(shape.points[i]);
            box.lower = glm::min(box.lower, point);
            box.upper = glm::max(box.upper, point);
        }
        return box;
    case PhysicsServer3D::SHAPE_HEIGHTMAP: {
        double lowest = kInfinite;
        double highest = -kInfinite;
        for (std::int64_t i = 0; i < shape.height_count; ++i) {
            const auto height = static_cast<double>(shape.heights[i]);
            lowest = height < lowest ? height : lowest; // false for NaN
            highest = height > highest ? height : highest;
        }
        box.upper = {0.5 * (shape.width - 1), highest, 0.5 * (shape.depth - 1)};
        box.lower = {-box.upper.x, lowest, -box.upper.z};
        return box;
    }
    default:
        return box;
    }
    box.lower = -box.upper;
    return box;
}

ShapeDescription describe(const ShapeNumbers &shape, const Vec3 &scale) {
    ShapeDescription result;
    if (!shape.evened && is_uneven(shape, scale)) {
        return stretched(shape, scale);
    }
    const Vec3 size = glm::abs(scale);
    const double mean = (size.x + size.y + size.z) / 3.0;
    switch (shape.type) {
    case PhysicsServer3D::SHAPE_SPHERE:
        result.kind = ShapeKind::sphere;
        result.radius_m = mean * shape.radius;
        break;
    case PhysicsServer3D::SHAPE_BOX:
        result.kind = ShapeKind::box;
        result.half_extents_m = size * shape.half_extents;
        break;
    case PhysicsServer3D::SHAPE_CAPSULE:
        result.kind = ShapeKind::capsule;
        result.radius_m = mean * shape.radius;
        result.half_height_m = mean * std::max(0.5 * shape.height - shape.radius, 0.0);
        break;
    case PhysicsServer3D::SHAPE_CYLINDER:
        result.kind = ShapeKind::cylinder;
        result.radius_m = 0.5 * (size.x + size.z) * shape.radius;
        result.half_height_m = 0.5 * size.y * shape.height;
        break;
    case PhysicsServer3D::SHAPE_CONVEX_POLYGON:
    case PhysicsServer3D::SHAPE_CONCAVE_POLYGON:
        return describe_points(shape, scale);
    case PhysicsServer3D::SHAPE_HEIGHTMAP:
        return describe_heights(shape, scale);
    default: // a world boundary: the only other one that is cooked
        result.kind = ShapeKind::half_space;
        result.normal = shape.normal / scale;
        result.offset_m = shape.offset / glm::length(result.normal);
        break;
    }
    return result;
}

CookResult cook_shape(const ShapeNumbers &shape, const Vec3 &scale) {
    ShapeDescription description = describe(shape, scale);
    if (description.kind != ShapeKind::hull) {
        return cook(std::move(description));
    }
    if (description.points_m.size() > kMostHullPoints) {
        description.points_m = outermost_points(description.points_m);
    }
    CookResult hull = cook(description);
    if (hull.status != Status::invalid_shape) {
        return hull;
    }
    CookResult flat = cook(flat_mesh(description.points_m));
    return usable(flat.status) ? flat : hull;
}

bool is_large(const ShapeNumbers &shape) noexcept {
    const bool hull = shape.type == PhysicsServer3D::SHAPE_CONVEX_POLYGON;
    return shape.point_count > (hull ? kMostHullPointsAtOnce : kMostPointsAtOnce) ||
           shape.height_count > kMostHeightsAtOnce;
}

} // namespace spidar
