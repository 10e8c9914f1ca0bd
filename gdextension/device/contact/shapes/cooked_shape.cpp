#include "device/contact/shapes/cooked_shape.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <string>

#include "core/base/finite.h"
#include "device/contact/shapes/hull_builder.h"
#include "device/contact/shapes/mesh_cooker.h"
#include "device/contact/shapes/shape_data.h"
#include "device/contact/shapes/triangle_source.h"

namespace spidar {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Largest number of hull points: points on a ball take a time that grows with their square, 0.2 s
// for this many.
constexpr std::size_t kMostHullPoints = 4096;
// Largest coordinate: hulls and trees are built in single precision, which must hold every squared
// distance.
constexpr double kMost_m = 1e6;

struct Refusal {
    Status status = Status::ok;
    std::string sentence;
};

Refusal wrong(std::string sentence) {
    return {Status::invalid_shape, std::move(sentence)};
}

Refusal not_finite(const char *field) {
    return {Status::not_finite, std::string(field) + " is NaN or infinite; give a finite number."};
}

Refusal check_size(double value, const char *field) {
    if (!std::isfinite(value)) {
        return not_finite(field);
    }
    return value > 0.0 ? Refusal{}
                       : wrong(std::string(field) + " is not above 0; give a number above 0.");
}

bool refused(const Refusal &refusal) {
    return !usable(refusal.status);
}

Refusal check_points(const ShapeDescription &shape) {
    for (const Vec3 &point : shape.points_m) {
        if (!all_finite(point)) {
            return not_finite("A point of points_m");
        }
        if (std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) > kMost_m) {
            return wrong("A point of points_m is more than 1000 km away.");
        }
    }
    return {};
}

void bound_points(CookedShape::Data &data) {
    data.lower_m = Vec3(kInfinite);
    data.upper_m = Vec3(-kInfinite);
    for (const Vec3 &point : data.description.points_m) {
        data.lower_m = glm::min(data.lower_m, point);
        data.upper_m = glm::max(data.upper_m, point);
    }
}

void bound_core(CookedShape::Data &data) {
    bounds_of(view_of(data.core), Mat3(1.0), data.lower_m, data.upper_m);
    data.lower_m -= Vec3(data.skin_m);
    data.upper_m += Vec3(data.skin_m);
}

Refusal cook_box(CookedShape::Data &data) {
    for (int axis = 0; axis < 3; ++axis) {
        const Refusal refusal =
            check_size(data.description.half_extents_m[axis], "half_extents_m of a box");
        if (refused(refusal)) {
            return refusal;
        }
    }
    data.core.kind = CoreKind::box;
    data.core.half_m = data.description.half_extents_m;
    bound_core(data);
    return {};
}

Refusal cook_round(CookedShape::Data &data) {
    const ShapeDescription &shape = data.description;
    Refusal refusal = check_size(shape.radius_m, "radius_m");
    if (refused(refusal)) {
        return refusal;
    }
    if (shape.kind != ShapeKind::sphere) {
        const bool ball = shape.kind == ShapeKind::capsule && shape.half_height_m == 0.0;
        refusal = ball ? Refusal{} : check_size(shape.half_height_m, "half_height_m");
        if (refused(refusal)) {
            return refusal;
        }
        data.core.half_height_m = shape.half_height_m;
    }
    if (shape.kind == ShapeKind::cylinder) {
        data.core.kind = CoreKind::cylinder;
        data.core.radius_m = shape.radius_m;
    } else {
        data.core.kind = shape.kind == ShapeKind::sphere ? CoreKind::point : CoreKind::segment;
        data.skin_m = shape.radius_m;
    }
    bound_core(data);
    return {};
}

Refusal cook_hull(CookedShape::Data &data) {
    Refusal refusal = check_points(data.description);
    if (refused(refusal)) {
        return refusal;
    }
    const std::size_t count = data.description.points_m.size();
    if (count < 4 || count > kMostHullPoints) {
        return wrong("A hull needs 4 to 4096 points_m; give more as a mesh, or leave some out.");
    }
    if (!build_hull(data.description.points_m, data.core)) {
        return wrong("The points_m of the hull lie in one plane; give a flat shape as a mesh.");
    }
    bound_core(data);
    return {};
}

Refusal cook_mesh(CookedShape::Data &data, int &dropped) {
    ShapeDescription &shape = data.description;
    Refusal refusal = check_points(shape);
    if (refused(refusal)) {
        return refusal;
    }
    if (shape.indices.empty() || shape.indices.size() % 3 != 0) {
        return wrong("A mesh needs indices, three for each triangle.");
    }
    const auto outside = [&shape](std::uint32_t index) { return index >= shape.points_m.size(); };
    if (std::any_of(shape.indices.begin(), shape.indices.end(), outside)) {
        return wrong("An index of the mesh is outside of points_m.");
    }
    dropped = weld(shape);
    if (shape.indices.empty()) {
        return wrong("Every triangle of the mesh has zero area.");
    }
    data.neighbours = find_neighbours(shape.indices);
    data.sharp_edges = find_sharp_edges(TriangleSource(data));
    data.tree = build_tree(shape.points_m, shape.indices);
    bound_points(data);
    return {};
}

Refusal cook_height_map(CookedShape::Data &data) {
    const ShapeDescription &map = data.description;
    Refusal refusal = check_size(map.spacing_x_m, "spacing_x_m");
    if (!refused(refusal)) {
        refusal = check_size(map.spacing_z_m, "spacing_z_m");
    }
    if (refused(refusal)) {
        return refusal;
    }
    constexpr int kMostPoints = 32768; // per side; cells are counted in 32 bits
    if (map.columns < 2 || map.rows < 2 || map.columns > kMostPoints || map.rows > kMostPoints) {
        return wrong("A height map needs 2 to 32768 columns and rows.");
    }
    const auto count = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
    if (map.heights_m.size() != count) {
        return wrong("heights_m of a height map needs columns * rows values.");
    }
    double lowest = kInfinite;
    double highest = -kInfinite;
    for (const float height : map.heights_m) {
        if (std::isinf(height)) {
            return not_finite("A height of heights_m");
        }
        if (!std::isnan(height)) {
            lowest = std::min(lowest, static_cast<double>(height));
            highest = std::max(highest, static_cast<double>(height));
        }
    }
    if (lowest > highest) {
        return wrong("Every height of the height map is a hole.");
    }
    data.upper_m = {0.5 * (map.columns - 1) * map.spacing_x_m, highest,
                    0.5 * (map.rows - 1) * map.spacing_z_m};
    data.lower_m = {-data.upper_m.x, lowest, -data.upper_m.z};
    return {};
}

Refusal cook_half_space(CookedShape::Data &data) {
    ShapeDescription &wall = data.description;
    if (!all_finite(wall.normal, wall.offset_m)) {
        return not_finite("normal or offset_m of a half space");
    }
    const double length = glm::length(wall.normal);
    if (!(length > 0.0) || !std::isfinite(length)) {
        return wrong("The normal of a half space is zero or too long; give a unit vector.");
    }
    // A normal that was normalized before stays unchanged, bit for bit.
    constexpr double kRoundings = 1e-14;
    if (std::abs(length - 1.0) > kRoundings) {
        wall.normal /= length;
    }
    data.lower_m = Vec3(-kInfinite);
    data.upper_m = Vec3(kInfinite);
    return {};
}

Refusal cook_relief(CookedShape::Data &data) {
    const ShapeDescription &map = data.description;
    constexpr int kFewest = 4; // a cubic B-spline has four heights in reach
    constexpr int kMost = 1024;
    if (map.columns < kFewest || map.rows < kFewest || map.columns > kMost || map.rows > kMost) {
        return wrong("A relief needs 4 to 1024 columns and rows.");
    }
    const auto count = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
    if (map.heights_m.size() != count) {
        return wrong("heights_m of a relief needs columns * rows values.");
    }
    for (const float height : map.heights_m) {
        if (!std::isfinite(height)) {
            return not_finite("A height of heights_m");
        }
        if (height < 0.0F || height > 1.0F) {
            return wrong("A height of a relief is outside 0 to 1; give heights from 0 to 1.");
        }
    }
    data.relief = make_relief_levels(map.columns, map.rows, map.heights_m);
    return {};
}

Refusal cook_kind(CookedShape::Data &data, int &dropped) {
    switch (data.description.kind) {
    case ShapeKind::box:
        return cook_box(data);
    case ShapeKind::sphere:
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
        return cook_round(data);
    case ShapeKind::hull:
        return cook_hull(data);
    case ShapeKind::mesh:
        return cook_mesh(data, dropped);
    case ShapeKind::height_map:
        return cook_height_map(data);
    case ShapeKind::half_space:
        return cook_half_space(data);
    case ShapeKind::relief:
        return cook_relief(data);
    }
    return wrong("This kind of shape is unknown.");
}

template <class T>
std::size_t bytes_of(const std::vector<T> &list) noexcept {
    return list.capacity() * sizeof(T);
}

} // namespace

std::uint64_t new_shape_number() noexcept {
    static std::atomic<std::uint64_t> last{0};
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

CookedShape::CookedShape(std::unique_ptr<const Data> data)
    : data_(std::move(data)), number_(new_shape_number()) {}
CookedShape::~CookedShape() = default;

ShapeKind CookedShape::kind() const noexcept {
    return data_->description.kind;
}

bool CookedShape::convex() const noexcept {
    return kind() != ShapeKind::mesh && kind() != ShapeKind::height_map &&
           kind() != ShapeKind::relief;
}

const ShapeDescription &CookedShape::description() const noexcept {
    return data_->description;
}

const ReliefLevels &CookedShape::relief() const noexcept {
    return data_->relief;
}

Vec3 CookedShape::lower_m() const noexcept {
    return data_->lower_m;
}

Vec3 CookedShape::upper_m() const noexcept {
    return data_->upper_m;
}

std::size_t CookedShape::bytes() const noexcept {
    const ShapeDescription &shape = data_->description;
    std::size_t relief_bytes = 0;
    for (const ReliefLevel &level : data_->relief) {
        relief_bytes += bytes_of(level.heights);
    }
    return sizeof(Data) + relief_bytes + bytes_of(shape.points_m) + bytes_of(shape.indices) +
           bytes_of(shape.heights_m) + bytes_of(data_->core.points) + bytes_of(data_->core.faces) +
           bytes_of(data_->core.face_points) + bytes_of(data_->neighbours) +
           bytes_of(data_->sharp_edges) + bytes_of(data_->tree.nodes) + bytes_of(data_->tree.order);
}

CookResult cook(ShapeDescription description) {
    CookResult result;
    auto data = std::make_unique<CookedShape::Data>();
    data->description = std::move(description);
    Refusal refusal = cook_kind(*data, result.dropped_triangles);
    result.status = refusal.status;
    result.sentence = std::move(refusal.sentence);
    if (!usable(result.status)) {
        return result;
    }
    if (result.dropped_triangles > 0) {
        result.sentence = std::to_string(result.dropped_triangles) +
                          " triangles with zero area were removed from the mesh.";
    }
    result.shape = std::make_shared<const CookedShape>(std::move(data));
    return result;
}

} // namespace spidar
