// Jolt's GJK, in float32, the tool at the origin; without its meshes, which need parts of it that are not compiled here.
#include <cstdarg>
#include <memory>
#include <vector>

#include <Jolt/Jolt.h>

#include <Jolt/Geometry/ConvexSupport.h>
#include <Jolt/Geometry/GJKClosestPoint.h>

#include "contact_peer.h"

namespace {

struct Shape {
    int kind = 0;
    JPH::Vec3 size = JPH::Vec3::sZero();
    std::vector<JPH::Vec3> points;

    [[nodiscard]] JPH::Vec3 GetSupport(JPH::Vec3Arg way) const {
        switch (kind) {
        case 0:
            return JPH::Vec3::sZero();
        case 1:
            return JPH::Vec3::sSelect(-size, size, JPH::Vec3::sGreaterOrEqual(way, JPH::Vec3::sZero()));
        case 2: {
            const float across = std::sqrt(way.GetX() * way.GetX() + way.GetZ() * way.GetZ());
            const float y = way.GetY() < 0 ? -size.GetY() : size.GetY();
            const float scale = across > 0 ? size.GetX() / across : 0;
            return {scale * way.GetX(), y, scale * way.GetZ()};
        }
        default: {
            const JPH::Vec3 *best = points.data();
            float farthest = best->Dot(way);
            for (const JPH::Vec3 &point : points) {
                const float distance = point.Dot(way);
                if (distance > farthest) {
                    farthest = distance;
                    best = &point;
                }
            }
            return *best;
        }
        }
    }
};

JPH::Vec3 column(const double *p) {
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

} // namespace

const char *peer_name(void) { return "Jolt 5.4.0, float32"; }

void *peer_shape(int kind, const double *size, const double *points, int point_count, const unsigned *, int) {
    if (kind > 3) {
        return nullptr;
    }
    auto shape = std::make_unique<Shape>();
    shape->kind = kind;
    if (size != nullptr) {
        shape->size = column(size);
    }
    for (int i = 0; i < point_count; ++i) {
        shape->points.push_back(column(points + 3 * i));
    }
    return shape.release();
}

double peer_distance(void *a, const double *pose_a, void *b, const double *pose_b, double *normal) {
    const auto *tool = static_cast<const Shape *>(a);
    const auto *other = static_cast<const Shape *>(b);
    double apart[12]; // the shape in the tool's frame
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 4; ++k) {
            double sum = 0.0;
            for (int j = 0; j < 3; ++j) {
                sum += pose_a[3 * i + j] * (pose_b[3 * k + j] - (k == 3 ? pose_a[9 + j] : 0.0));
            }
            apart[3 * k + i] = sum;
        }
    }
    const JPH::Mat44 at(JPH::Vec4(column(apart), 0), JPH::Vec4(column(apart + 3), 0), JPH::Vec4(column(apart + 6), 0),
                        JPH::Vec4(column(apart + 9), 1));
    const JPH::TransformedConvexObject<Shape> placed(at, *other);
    JPH::GJKClosestPoint gjk;
    JPH::Vec3 v = -at.GetTranslation();
    JPH::Vec3 on_a;
    JPH::Vec3 on_b;
    const float distance2 = gjk.GetClosestPoints(*tool, placed, 1e-6F, FLT_MAX, v, on_a, on_b);
    const double radius = (tool->kind == 0 ? static_cast<double>(tool->size.GetX()) : 0.0) +
                          (other->kind == 0 ? static_cast<double>(other->size.GetX()) : 0.0);
    // v leads from the tool to the shape or back: the points tell.
    const JPH::Vec3 way = (on_a - on_b).NormalizedOr(JPH::Vec3::sAxisY());
    for (int i = 0; i < 3; ++i) {
        normal[i] = 0.0;
        for (int j = 0; j < 3; ++j) {
            normal[i] += pose_a[3 * j + i] * static_cast<double>(way[static_cast<JPH::uint>(j)]);
        }
    }
    return static_cast<double>(std::sqrt(distance2)) - radius;
}
