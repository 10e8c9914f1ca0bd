// Reads the kind and the sizes of a shape from the physics server, in the shape's frame and units.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/rid.hpp>
#include <godot_cpp/variant/vector3.hpp>

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Kind and sizes, which any thread may read. ShapeData owns the points and heights.
struct ShapeNumbers {
    godot::PhysicsServer3D::ShapeType type = godot::PhysicsServer3D::SHAPE_CUSTOM;
    double radius = 0.0;
    double height = 0.0;    // whole height, with the caps of a capsule
    Vec3 half_extents{0.0}; // of a box
    Vec3 normal{0.0};       // of a world boundary
    double offset = 0.0;    // of a world boundary: solid below normal . x = offset
    bool two_sided = false;
    bool evened = true;                     // EngineHabits::evens_round_shapes
    const godot::Vector3 *points = nullptr; // of a hull; of a mesh, three per triangle, clockwise
    std::int64_t point_count = 0;
    const float *heights = nullptr; // of a height map: width times depth values
    std::int64_t height_count = 0;
    int width = 0;
    int depth = 0;
};

// Bounding box; infinite for a world boundary, or when unknown.
struct ShapeBounds {
    Vec3 lower{-std::numeric_limits<double>::infinity()};
    Vec3 upper{std::numeric_limits<double>::infinity()};
    [[nodiscard]] bool known() const noexcept { return std::isfinite(upper.x); }
};

// The numbers and the arrays to which they point. Main thread only.
struct ShapeData {
    ShapeNumbers numbers;
    godot::PackedVector3Array points;
    godot::PackedFloat32Array heights;
    ShapeBounds bounds;
    bool readable = false; // the server reported data of the type that the shape's kind has
};

// Difference between new and old data.
enum class DataChange : std::uint8_t {
    none,
    // The data are equal, but the server copied them for this read, which takes long for many.
    copied,
    changed
};

// Reads shapes from the physics server. Keeps the keys of the server's dictionaries, so that a read
// creates no strings.
class ShapeReader {
public:
    ShapeReader();
    // Reads a shape. A large shape (is_large()) gets no bounds, since bounds_of() takes long.
    [[nodiscard]] ShapeData read(const godot::RID &shape) const;
    // Reads the shape again and overwrites `data` if it changed.
    [[nodiscard]] DataChange read_again(const godot::RID &shape, ShapeData &data) const;

private:
    [[nodiscard]] ShapeData take(const godot::RID &shape) const;
    godot::Variant radius_;
    godot::Variant height_;
    godot::Variant faces_;
    godot::Variant backface_collision_;
    godot::Variant heights_;
    godot::Variant width_;
    godot::Variant depth_;
};

// Computes the bounding box. Any thread.
[[nodiscard]] ShapeBounds bounds_of(const ShapeNumbers &shape);

// Returns the shape scaled to device meters. scale: device meters per shape unit along each axis;
// negative x: mirrored. Any thread.
[[nodiscard]] ShapeDescription describe(const ShapeNumbers &shape, const Vec3 &scale);

// Cooks the shape; a hull whose points lie in one plane becomes a two-sided mesh. Any thread.
[[nodiscard]] CookResult cook_shape(const ShapeNumbers &shape, const Vec3 &scale);

// Returns whether the shape has so many points or heights that cooking it within a frame would be
// noticeable.
[[nodiscard]] bool is_large(const ShapeNumbers &shape) noexcept;

} // namespace spidar
