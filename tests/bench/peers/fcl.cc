// FCL's distance query, in double precision, by its own GJK and by libccd where that is its default.
#include <cstddef>
#include <memory>
#include <vector>

#include <fcl/config.h>
#include <fcl/fcl.h>

#include "contact_peer.h"

namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

// FCL's cylinders stand along Z: ours are turned.
struct Shape {
    Geometry geometry;
    fcl::Matrix3d turn = fcl::Matrix3d::Identity();
};

fcl::Vector3d at(const double *points, int i) { return {points[3 * i], points[3 * i + 1], points[3 * i + 2]}; }

// FCL wants the faces of a hull; all triples of corners with the others behind them, for a few corners.
Geometry hull(const double *points, int count) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (int i = 0; i < count; ++i) {
        vertices->push_back(at(points, i));
    }
    auto faces = std::make_shared<std::vector<int>>();
    int face_count = 0;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            for (int k = 0; k < count; ++k) {
                if (i >= j || i >= k || j == k) {
                    continue;
                }
                const fcl::Vector3d normal = (at(points, j) - at(points, i)).cross(at(points, k) - at(points, i));
                bool outside = normal.norm() > 0.0;
                for (int other = 0; outside && other < count; ++other) {
                    outside = normal.dot(at(points, other) - at(points, i)) <= 1e-12 * normal.norm();
                }
                if (outside) {
                    faces->insert(faces->end(), {3, i, j, k});
                    ++face_count;
                }
            }
        }
    }
    return std::make_shared<fcl::Convexd>(vertices, face_count, faces);
}

Geometry mesh(const double *points, int count, const unsigned *indices, int triangles) {
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Vector3d> vertices;
    for (int i = 0; i < count; ++i) {
        vertices.push_back(at(points, i));
    }
    std::vector<fcl::Triangle> faces;
    for (int i = 0; i < triangles; ++i) {
        faces.emplace_back(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]);
    }
    model->beginModel();
    model->addSubModel(vertices, faces);
    model->endModel();
    return model;
}

fcl::Transform3d placed(const Shape &shape, const double *pose) {
    fcl::Transform3d placed = fcl::Transform3d::Identity();
    fcl::Matrix3d turn;
    turn << pose[0], pose[3], pose[6], pose[1], pose[4], pose[7], pose[2], pose[5], pose[8];
    placed.linear() = turn * shape.turn;
    placed.translation() = fcl::Vector3d(pose[9], pose[10], pose[11]);
    return placed;
}

} // namespace

const char *peer_name(void) { return "FCL " FCL_VERSION; }

void *peer_shape(int kind, const double *size, const double *points, int point_count, const unsigned *indices,
                 int triangle_count) {
    auto shape = std::make_unique<Shape>();
    switch (kind) {
    case 0:
        shape->geometry = std::make_shared<fcl::Sphered>(size[0]);
        break;
    case 1:
        shape->geometry = std::make_shared<fcl::Boxd>(2 * size[0], 2 * size[1], 2 * size[2]);
        break;
    case 2:
        shape->geometry = std::make_shared<fcl::Cylinderd>(size[0], 2 * size[1]);
        shape->turn << 1, 0, 0, 0, 0, 1, 0, -1, 0; // Z of the cylinder to our Y
        break;
    case 3:
        shape->geometry = hull(points, point_count);
        break;
    default:
        shape->geometry = mesh(points, point_count, indices, triangle_count);
    }
    return shape.release();
}

double peer_distance(void *a, const double *pose_a, void *b, const double *pose_b, double *normal) {
    const auto *first = static_cast<Shape *>(a);
    const auto *second = static_cast<Shape *>(b);
    fcl::DistanceRequestd request;
    request.enable_nearest_points = true;
    request.distance_tolerance = 1e-9;
    fcl::DistanceResultd result;
    const double distance = fcl::distance(first->geometry.get(), placed(*first, pose_a), second->geometry.get(),
                                          placed(*second, pose_b), request, result);
    const fcl::Vector3d apart = (result.nearest_points[0] - result.nearest_points[1]).normalized();
    for (int i = 0; i < 3; ++i) {
        normal[i] = apart[i];
    }
    return distance;
}
