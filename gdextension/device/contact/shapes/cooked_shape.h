// A shape of the scene, prepared for questions of the servo loop: hulls have their faces, meshes their tree of
// triangles. Cooking allocates and takes from microseconds to some tenths of a second; it runs outside the servo
// thread, on any thread. A cooked shape never changes, so any number of threads may read it at once. The game side
// owns it by shared_ptr; the servo side holds a plain pointer while the game keeps the owner alive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

// The numbers are part of recordings: new kinds go to the end.
enum class ShapeKind : std::uint8_t {
    box = 0,      // half_extents_m
    sphere = 1,   // radius_m
    capsule = 2,  // radius_m and half_height_m of its straight part, along Y
    cylinder = 3, // radius_m and half_height_m, along Y
    hull = 4,     // the convex hull of points_m
    mesh =
        5, // triangles: three indices into points_m each; counter-clockwise seen from their front
    height_map = 6, // heights_m over a grid in X and Z
    half_space = 7, // solid below the plane normal . x = offset_m
    relief = 8,     // no solid: heights_m of a texture, from 0 to 1, that repeats (relief_map.h)
};

// What to cook, in the shape's own frame (m). Scale is already applied: a box of twice the size has twice the half
// extents. Only the fields named at its kind are read. A recording keeps this, and cooking it again gives the same shape.
struct ShapeDescription {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_extents_m{0.0};
    double radius_m = 0.0;
    double half_height_m = 0.0;
    std::vector<Vec3> points_m;
    std::vector<std::uint32_t> indices;
    // Mesh and height map: whether back faces are solid too. The front of a height map is up (+Y).
    bool two_sided = false;
    // Height map: columns along X and rows along Z, centred on the origin; heights_m[row * columns + column]. A NaN is a
    // hole: the triangles that touch it are left out.
    int columns = 0;
    int rows = 0;
    double spacing_x_m = 1.0;
    double spacing_z_m = 1.0;
    std::vector<float> heights_m;
    Vec3 normal{0.0, 1.0, 0.0};
    double offset_m = 0.0;
};

struct CookResult;

// The next one that no shape has had.
[[nodiscard]] std::uint64_t new_shape_number() noexcept;

class CookedShape {
public:
    struct Data; // shape_data.h; only this room looks inside

    explicit CookedShape(std::unique_ptr<const Data> data);
    ~CookedShape();
    CookedShape(const CookedShape &) = delete;
    CookedShape &operator=(const CookedShape &) = delete;

    [[nodiscard]] ShapeKind kind() const noexcept;
    [[nodiscard]] bool convex() const noexcept; // every kind but mesh, height_map and relief
    // Bounding box in the shape's frame (m). A half space is infinite in all directions; a relief is empty.
    [[nodiscard]] Vec3 lower_m() const noexcept;
    [[nodiscard]] Vec3 upper_m() const noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept;
    [[nodiscard]] const Data &data() const noexcept { return *data_; }
    // As it was cooked, a mesh welded: cooking this again gives the same shape, bit for bit, with another number.
    [[nodiscard]] const ShapeDescription &description() const noexcept;

    // No other cooked or tool shape of this process has it, now or later: what was remembered of a shape is not taken for
    // another's.
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

private:
    std::unique_ptr<const Data> data_;
    std::uint64_t number_;
};

struct CookResult {
    Status status = Status::ok;
    // What was wrong and which field; when shape is set and triangles were dropped, a remark on them. Empty otherwise.
    std::string sentence;
    std::shared_ptr<const CookedShape> shape; // set if usable(status)
    int dropped_triangles = 0;                // of a mesh: without area
};

// Status::not_finite, or Status::invalid_shape for what has no volume or no triangle: no size, a flat or empty hull, an
// index that is no vertex. A flat hull is to be given as a mesh.
[[nodiscard]] CookResult cook(ShapeDescription description);

} // namespace spidar
