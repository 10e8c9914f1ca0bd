// What the physics server knows of one shape: its kind and its sizes, in the shape's own frame and the scene's units.
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

// Plain numbers that any thread may read. The points and heights belong to the ShapeData that holds them.
struct ShapeNumbers {
    godot::PhysicsServer3D::ShapeType type = godot::PhysicsServer3D::SHAPE_CUSTOM;
    double radius = 0.0;
    double height = 0.0;    // whole, with the caps of a capsule
    Vec3 half_extents{0.0}; // of a box
    Vec3 normal{0.0};       // of a world boundary
    double offset = 0.0;    // of a world boundary: solid below normal . x = offset
    bool two_sided = false;
    bool evened = true; // round shapes of uneven scale take the mean of their scales
    const godot::Vector3 *points = nullptr; // of a hull; of a mesh three a triangle, clockwise
    std::int64_t point_count = 0;
    const float *heights = nullptr; // of a height map: width times depth of them
    std::int64_t height_count = 0;
    int width = 0;
    int depth = 0;
};

// Infinite: of a world boundary, or not known yet.
struct ShapeBounds {
    Vec3 lower{-std::numeric_limits<double>::infinity()};
    Vec3 upper{std::numeric_limits<double>::infinity()};
    [[nodiscard]] bool known() const noexcept { return std::isfinite(upper.x); }
};

// The numbers with what they point to. Main thread only.
struct ShapeData {
    ShapeNumbers numbers;
    godot::PackedVector3Array points;
    godot::PackedFloat32Array heights;
    ShapeBounds bounds;
    bool readable = false; // the server gave what its kind should have
};

// How new data differ from old ones.
enum class DataChange : std::uint8_t {
    none,
    copied, // equal, but the server made a copy to tell so: looking is as dear as the data are many
    changed
};

// Reads shapes from the physics server. Holds the names of the data's parts, so that no text is made at each look.
class ShapeReader {
public:
    ShapeReader();
    // The bounds of a large shape are left open: bounds_of() takes long.
    [[nodiscard]] ShapeData read(const godot::RID &shape) const;
    // Reads again, into `data`.
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

// Any thread.
[[nodiscard]] ShapeBounds bounds_of(const ShapeNumbers &shape);

// What to cook: the shape after `scale` (device metres for a unit of the shape, by axis; x below zero: mirrored). Any thread.
[[nodiscard]] ShapeDescription describe(const ShapeNumbers &shape, const Vec3 &scale);

// Cooks it; a hull whose points lie in one plane becomes a mesh of two sides. Any thread.
[[nodiscard]] CookResult cook_shape(const ShapeNumbers &shape, const Vec3 &scale);

// More than is cooked between two frames without being noticed.
[[nodiscard]] bool is_large(const ShapeNumbers &shape) noexcept;

} // namespace spidar
