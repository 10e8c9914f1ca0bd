// A shape of the scene, prepared for the servo loop: hulls have faces, meshes a tree of triangles.
// Cooking allocates and takes from microseconds to some tenths of a second: run it outside the
// servo thread. A cooked shape never changes, so that any thread may read it. The game owns it by
// shared_ptr; the servo loop holds a plain pointer while the owner lives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/base/types.h"
#include "device/contact/relief/relief_map.h"

namespace spidar {

// The values are stored in recordings: append new kinds.
enum class ShapeKind : std::uint8_t {
    box = 0,    // half_extents_m
    sphere = 1, // radius_m
    // radius_m, and half_height_m of its straight part along Y.
    capsule = 2,
    cylinder = 3, // radius_m and half_height_m, along Y
    hull = 4,     // the convex hull of points_m
    // Triangles with three indices into points_m each, counter-clockwise seen from the front.
    mesh = 5,
    height_map = 6, // heights_m over a grid in X and Z
    half_space = 7, // solid below the plane normal . x = offset_m
    // Not a solid: heights_m of a texture, from 0 to 1, in columns and rows (relief_map.h).
    relief = 8,
};

// What to cook, in the shape's frame (unit: m) with the scale applied. Each kind reads only its own
// fields, which are named here and at ShapeKind. A recording stores the description; cooking it
// again gives the same shape.
struct ShapeDescription {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_extents_m{0.0};
    double radius_m = 0.0;
    double half_height_m = 0.0;
    std::vector<Vec3> points_m;
    std::vector<std::uint32_t> indices;
    // Mesh and height map: true when back faces are solid too. The front of a height map faces +Y.
    bool two_sided = false;
    // Height map: columns along X and rows along Z, centered on the origin; heights_m[row * columns
    // + column]. A NaN is a hole: triangles that touch it are omitted.
    int columns = 0;
    int rows = 0;
    double spacing_x_m = 1.0;
    double spacing_z_m = 1.0;
    std::vector<float> heights_m;
    Vec3 normal{0.0, 1.0, 0.0};
    double offset_m = 0.0;
};

struct CookResult;

// Returns a number that no shape of this process has had.
[[nodiscard]] std::uint64_t new_shape_number() noexcept;

class CookedShape {
public:
    struct Data; // shape_data.h; used within this folder only

    explicit CookedShape(std::unique_ptr<const Data> data);
    ~CookedShape();
    CookedShape(const CookedShape &) = delete;
    CookedShape &operator=(const CookedShape &) = delete;

    [[nodiscard]] ShapeKind kind() const noexcept;
    // False for mesh, height_map and relief.
    [[nodiscard]] bool convex() const noexcept;
    // Bounding box in the shape's frame (unit: m). A half space is infinite in all directions; the
    // box of a relief has no size.
    [[nodiscard]] Vec3 lower_m() const noexcept;
    [[nodiscard]] Vec3 upper_m() const noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept;
    [[nodiscard]] const Data &data() const noexcept { return *data_; }
    // The description that was cooked, with a mesh welded. Cooking it again gives the same shape
    // bit for bit, with another number.
    [[nodiscard]] const ShapeDescription &description() const noexcept;
    // Empty for all kinds but relief.
    [[nodiscard]] const ReliefLevels &relief() const noexcept;

    // Unique among all cooked and tool shapes of this process, so that data stored under a number
    // cannot be taken for another shape's.
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

private:
    std::unique_ptr<const Data> data_;
    std::uint64_t number_;
};

struct CookResult {
    Status status = Status::ok;
    // The problem and its field, or with `shape` set a remark on dropped triangles. Else empty.
    std::string sentence;
    std::shared_ptr<const CookedShape> shape; // set if usable(status)
    // Number of mesh triangles without area that were dropped.
    int dropped_triangles = 0;
};

// Cooks a shape. Refuses with not_finite or invalid_shape a description that makes no shape, such
// as a size of 0, a flat hull, or an index without a point. Give a flat hull as a mesh.
[[nodiscard]] CookResult cook(ShapeDescription description);

} // namespace spidar
