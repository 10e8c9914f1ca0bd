#include "device/contact/shapes/triangle_tree.h"

#include <cmath>
#include <limits>

#include <Jolt/Jolt.h>

#include <Jolt/AABBTree/AABBTreeBuilder.h>
#include <Jolt/TriangleSplitter/TriangleSplitterBinning.h>

namespace spidar {

namespace {

constexpr JPH::uint kTrianglesInLeaf = 4;

// Widens a box by the rounding of corners to single precision.
float below(float value) {
    return std::nextafter(value, -std::numeric_limits<float>::infinity());
}
float above(float value) {
    return std::nextafter(value, std::numeric_limits<float>::infinity());
}

class Layout {
public:
    Layout(const JPH::AABBTreeBuilder &builder, TriangleTree &tree)
        : nodes_(builder.GetNodes()), triangles_(builder.GetTriangles()), tree_(tree) {}

    // Depth first, with an explicit stack, since a tree of many equal triangles may be deep.
    void lay_out(const JPH::AABBTreeBuilder::Node &root) {
        struct Step {
            const JPH::AABBTreeBuilder::Node *node;
            std::size_t closes; // place whose skip is now known; node is null then
        };
        std::vector<Step> steps{{&root, 0}};
        while (!steps.empty()) {
            const Step step = steps.back();
            steps.pop_back();
            if (step.node == nullptr) {
                tree_.nodes[step.closes].skip = static_cast<std::uint32_t>(tree_.nodes.size());
                continue;
            }
            const std::size_t place = add(*step.node);
            steps.push_back({nullptr, place});
            for (const JPH::uint child : {step.node->mChild[1], step.node->mChild[0]}) {
                if (child != JPH::AABBTreeBuilder::Node::cInvalidNodeIndex) {
                    steps.push_back({&nodes_[child], 0});
                }
            }
        }
    }

private:
    std::size_t add(const JPH::AABBTreeBuilder::Node &node) {
        TreeNode made;
        for (JPH::uint axis = 0; axis < 3; ++axis) {
            made.lower[axis] = below(node.mBounds.mMin[axis]);
            made.upper[axis] = above(node.mBounds.mMax[axis]);
        }
        made.first = static_cast<std::uint32_t>(tree_.order.size());
        made.count = node.mNumTriangles;
        for (JPH::uint i = 0; i < node.mNumTriangles; ++i) {
            tree_.order.push_back(triangles_[node.mTrianglesBegin + i].mUserData);
        }
        tree_.nodes.push_back(made);
        return tree_.nodes.size() - 1;
    }

    const JPH::Array<JPH::AABBTreeBuilder::Node> &nodes_;
    const JPH::Array<JPH::IndexedTriangle> &triangles_;
    TriangleTree &tree_;
};

} // namespace

TriangleTree build_tree(std::span<const Vec3> points, std::span<const std::uint32_t> indices) {
    JPH::VertexList vertices;
    vertices.reserve(points.size());
    for (const Vec3 &point : points) {
        vertices.push_back(JPH::Float3(static_cast<float>(point.x), static_cast<float>(point.y),
                                       static_cast<float>(point.z)));
    }
    JPH::IndexedTriangleList triangles;
    triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        triangles.push_back(JPH::IndexedTriangle(indices[i], indices[i + 1], indices[i + 2], 0,
                                                 static_cast<JPH::uint>(i / 3)));
    }
    JPH::TriangleSplitterBinning splitter(vertices, triangles);
    JPH::AABBTreeBuilder builder(splitter, kTrianglesInLeaf);
    JPH::AABBTreeBuilderStats stats;
    const JPH::AABBTreeBuilder::Node *root = builder.Build(stats);
    TriangleTree tree;
    Layout(builder, tree).lay_out(*root);
    return tree;
}

} // namespace spidar
