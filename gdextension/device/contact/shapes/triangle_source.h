// The triangles of a mesh or of a height map's grid, by number. Used within this folder only.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "device/contact/shapes/shape_data.h"

namespace spidar {

using Corners = std::array<Vec3, 3>; // counter-clockwise seen from the front

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Returns the unit normal on the front side.
[[nodiscard]] inline Vec3 normal_of(const Corners &triangle) noexcept {
    return glm::normalize(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
}

// Cell c of a height map has the triangles 2 c and 2 c + 1. The cut between them runs from the
// height at (column + 1, row) to the one at (column, row + 1), as in the engine's physics. A cell
// has the number of its corner with the lowest column and row: row * columns + column.
class TriangleSource {
public:
    explicit TriangleSource(const CookedShape::Data &data) noexcept
        : data_(data), grid_(data.description.kind == ShapeKind::height_map) {}

    [[nodiscard]] bool two_sided() const noexcept { return data_.description.two_sided; }

    // Returns the numbers of a triangle's corners; equal numbers are one corner.
    [[nodiscard]] std::array<std::uint32_t, 3>
    corner_numbers(std::uint32_t triangle) const noexcept {
        if (!grid_) {
            const auto first = static_cast<std::size_t>(triangle) * 3;
            const auto &indices = data_.description.indices;
            return {indices[first], indices[first + 1], indices[first + 2]};
        }
        const auto columns = static_cast<std::uint32_t>(data_.description.columns);
        const std::uint32_t cell = triangle / 2;
        if (triangle % 2 == 0) {
            return {cell, cell + columns, cell + 1};
        }
        return {cell + 1, cell + columns, cell + columns + 1};
    }

    [[nodiscard]] Corners corners(std::uint32_t triangle) const noexcept {
        const auto numbers = corner_numbers(triangle);
        return {corner(numbers[0]), corner(numbers[1]), corner(numbers[2])};
    }

    // Returns the triangle across edge i (from corner i to the next); kNone at a border.
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t triangle, std::size_t edge) const noexcept {
        if (!grid_) {
            return data_.neighbours[triangle][edge];
        }
        const int columns = data_.description.columns;
        const auto cell = static_cast<int>(triangle / 2);
        const int column = cell % columns;
        const int row = cell / columns;
        if (triangle % 2 == 0) {
            return edge == 0   ? grid_triangle(column - 1, row, 1)
                   : edge == 1 ? grid_triangle(column, row, 1)
                               : grid_triangle(column, row - 1, 1);
        }
        return edge == 0   ? grid_triangle(column, row, 0)
               : edge == 1 ? grid_triangle(column, row + 1, 0)
                           : grid_triangle(column + 1, row, 0);
    }

    // Returns NearTriangle::sharp_edges: stored for a mesh, computed for a grid.
    [[nodiscard]] std::uint8_t sharp_edges(std::uint32_t triangle) const noexcept {
        return grid_ ? measure_edges(triangle) : data_.sharp_edges[triangle];
    }

    [[nodiscard]] std::uint8_t measure_edges(std::uint32_t triangle) const noexcept {
        unsigned bits = 0;
        const Corners mine = corners(triangle);
        const auto numbers = corner_numbers(triangle);
        for (std::size_t edge = 0; edge < 3; ++edge) {
            bits |=
                sharpness(mine, neighbour(triangle, edge), numbers[edge], numbers[(edge + 1) % 3])
                << edge;
        }
        return static_cast<std::uint8_t>(bits);
    }

    [[nodiscard]] std::size_t mesh_triangles() const noexcept {
        return data_.description.indices.size() / 3;
    }

    // Calls visit(triangle) for all triangles that may meet the box, and possibly for others.
    template <class Visit>
    void visit_box(const Vec3 &lower_m, const Vec3 &upper_m, Visit &&visit) const {
        if (!grid_) {
            data_.tree.visit_box(lower_m, upper_m, visit);
            return;
        }
        const ShapeDescription &map = data_.description;
        if (!(lower_m.y <= data_.upper_m.y && upper_m.y >= data_.lower_m.y)) {
            return;
        }
        const int first_column = cell_at(lower_m.x, map.spacing_x_m, map.columns);
        const int last_column = cell_at(upper_m.x, map.spacing_x_m, map.columns);
        const int first_row = cell_at(lower_m.z, map.spacing_z_m, map.rows);
        const int last_row = cell_at(upper_m.z, map.spacing_z_m, map.rows);
        for (int row = first_row; row <= last_row; ++row) {
            for (int column = first_column; column <= last_column; ++column) {
                for (int half = 0; half < 2; ++half) {
                    const std::uint32_t triangle = grid_triangle(column, row, half);
                    if (triangle != kNone) {
                        visit(triangle);
                    }
                }
            }
        }
    }

private:
    static constexpr unsigned kSharp = 1;
    static constexpr unsigned kCrease = 16; // sharp, and bent by more than 3 degrees

    // Returns the bits of one edge, shifted to edge 0.
    [[nodiscard]] unsigned sharpness(const Corners &triangle, std::uint32_t neighbour,
                                     std::uint32_t first_shared,
                                     std::uint32_t second_shared) const noexcept {
        // An edge is sharp when the other face's far corner lies below this face's plane (of a
        // two-sided shape, also above it) by more than this share of its distance from corner 0:
        // about the sine of the bend.
        constexpr double kFlatEdge = 1e-6;
        constexpr double kOneFace = 0.9986; // cosine of 3 degrees
        if (neighbour == kNone) {
            return kSharp | kCrease;
        }
        const auto numbers = corner_numbers(neighbour);
        const Corners other = corners(neighbour);
        const Vec3 normal = normal_of(triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            if (numbers[i] == first_shared || numbers[i] == second_shared) {
                continue;
            }
            // The edge is convex when the other corner lies below the plane of this triangle.
            const Vec3 from = other[i] - triangle[0];
            const double rise = glm::dot(from, normal);
            const double limit = kFlatEdge * glm::length(from);
            if (rise < -limit || (two_sided() && rise > limit)) {
                return glm::dot(normal, normal_of(other)) < kOneFace ? kSharp | kCrease : kSharp;
            }
            return 0;
        }
        return kSharp | kCrease; // both have the same corners
    }

    [[nodiscard]] Vec3 corner(std::uint32_t number) const noexcept {
        const ShapeDescription &shape = data_.description;
        if (!grid_) {
            return shape.points_m[number];
        }
        const auto columns = static_cast<std::uint32_t>(shape.columns);
        const std::uint32_t column = number % columns;
        const std::uint32_t row = number / columns;
        return {(column - 0.5 * (shape.columns - 1)) * shape.spacing_x_m,
                static_cast<double>(shape.heights_m[number]),
                (row - 0.5 * (shape.rows - 1)) * shape.spacing_z_m};
    }

    // Returns kNone outside the grid and at a hole.
    [[nodiscard]] std::uint32_t grid_triangle(int column, int row, int half) const noexcept {
        const ShapeDescription &map = data_.description;
        if (column < 0 || row < 0 || column >= map.columns - 1 || row >= map.rows - 1) {
            return kNone;
        }
        const auto triangle = static_cast<std::uint32_t>(2 * (row * map.columns + column) + half);
        for (const std::uint32_t number : corner_numbers(triangle)) {
            if (std::isnan(map.heights_m[number])) {
                return kNone;
            }
        }
        return triangle;
    }

    // Returns the cell of a coordinate; outside the grid the nearest cell.
    [[nodiscard]] static int cell_at(double coordinate_m, double spacing_m, int points) noexcept {
        const double place = std::floor(coordinate_m / spacing_m + 0.5 * (points - 1));
        return static_cast<int>(std::fmin(std::fmax(place, 0.0), points - 2.0));
    }

    const CookedShape::Data &data_;
    bool grid_;
};

// True when a point's foot on the triangle's plane is inside or, within rounding, on an edge.
[[nodiscard]] inline bool over_triangle(const Vec3 &point, const Corners &triangle) noexcept {
    constexpr double kEdge_m = 1e-9; // this much outside counts as inside
    const Vec3 area = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double slack = kEdge_m * glm::length(area);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = triangle[(i + 1) % 3] - triangle[i];
        // At least the length of the edge.
        const double length = std::abs(edge.x) + std::abs(edge.y) + std::abs(edge.z);
        if (glm::dot(glm::cross(edge, point - triangle[i]), area) < -slack * length) {
            return false;
        }
    }
    return true;
}

} // namespace spidar
