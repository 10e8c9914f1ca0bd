// Bullet's GJK, in the float32 of Debian's package.
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

#include "contact_peer.h"

namespace {

struct Shape {
    std::unique_ptr<btTriangleMesh> triangles;
    std::unique_ptr<btCollisionShape> shape;
};

btVector3 at(const double *points, unsigned i) {
    return {static_cast<btScalar>(points[3 * i]), static_cast<btScalar>(points[3 * i + 1]),
            static_cast<btScalar>(points[3 * i + 2])};
}

btTransform placed(const double *p) {
    const auto f = [p](int i) { return static_cast<btScalar>(p[i]); };
    return btTransform(btMatrix3x3(f(0), f(3), f(6), f(1), f(4), f(7), f(2), f(5), f(8)), btVector3(f(9), f(10), f(11)));
}

btPointCollector nearest(const btConvexShape *a, const btTransform &at_a, const btConvexShape *b,
                         const btTransform &at_b) {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(a, b, &simplex, &depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = at_a;
    input.m_transformB = at_b;
    btPointCollector found;
    detector.getClosestPoints(input, found, nullptr);
    return found;
}

struct EachTriangle : btTriangleCallback {
    const btConvexShape *tool = nullptr;
    btTransform tool_at;
    btTransform mesh_at;
    btPointCollector best;

    void processTriangle(btVector3 *corners, int, int) override {
        btTriangleShape triangle(corners[0], corners[1], corners[2]);
        triangle.setMargin(0);
        const btPointCollector found = nearest(tool, tool_at, &triangle, mesh_at);
        if (found.m_hasResult && found.m_distance < best.m_distance) {
            best = found;
        }
    }
};

} // namespace

const char *peer_name(void) {
    static const std::string name = "Bullet " + std::to_string(btGetVersion()) + ", float32";
    return name.c_str();
}

void *peer_shape(int kind, const double *size, const double *points, int point_count, const unsigned *indices,
                 int triangle_count) {
    auto made = std::make_unique<Shape>();
    const auto f = [size](int i) { return static_cast<btScalar>(size[i]); };
    switch (kind) {
    case 0:
        made->shape = std::make_unique<btSphereShape>(f(0));
        return made.release(); // its margin is its radius
    case 1:
        made->shape = std::make_unique<btBoxShape>(btVector3(f(0), f(1), f(2)));
        break;
    case 2:
        made->shape = std::make_unique<btCylinderShape>(btVector3(f(0), f(1), f(0)));
        break;
    case 3: {
        auto hull = std::make_unique<btConvexHullShape>();
        for (int i = 0; i < point_count; ++i) {
            hull->addPoint(at(points, static_cast<unsigned>(i)), false);
        }
        hull->recalcLocalAabb();
        made->shape = std::move(hull);
        break;
    }
    default:
        made->triangles = std::make_unique<btTriangleMesh>();
        for (int i = 0; i < triangle_count; ++i) {
            made->triangles->addTriangle(at(points, indices[3 * i]), at(points, indices[3 * i + 1]),
                                         at(points, indices[3 * i + 2]));
        }
        made->shape = std::make_unique<btBvhTriangleMeshShape>(made->triangles.get(), true);
    }
    made->shape->setMargin(0);
    return made.release();
}

double peer_distance(void *a, const double *pose_a, void *b, const double *pose_b, double *normal) {
    const auto *tool = static_cast<const btConvexShape *>(static_cast<Shape *>(a)->shape.get());
    const btCollisionShape *other = static_cast<Shape *>(b)->shape.get();
    btPointCollector found;
    if (other->isConvex()) {
        found = nearest(tool, placed(pose_a), static_cast<const btConvexShape *>(other), placed(pose_b));
    } else {
        EachTriangle each;
        each.tool = tool;
        each.tool_at = placed(pose_a);
        each.mesh_at = placed(pose_b);
        // Within 10 mm, more than any pair of the bench is apart.
        btVector3 lower;
        btVector3 upper;
        tool->getAabb(each.mesh_at.inverse() * each.tool_at, lower, upper);
        const btVector3 margin(0.01F, 0.01F, 0.01F);
        static_cast<const btBvhTriangleMeshShape *>(other)->processAllTriangles(&each, lower - margin, upper + margin);
        found = each.best;
    }
    if (!found.m_hasResult) {
        return -1.0;
    }
    for (int i = 0; i < 3; ++i) {
        normal[i] = static_cast<double>(found.m_normalOnBInWorld[i]);
    }
    return static_cast<double>(found.m_distance);
}
