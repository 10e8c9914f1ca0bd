// A tree of bounding boxes of a mesh's triangles, built by Jolt; its traversal needs no
// stack.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace spidar {

// Nodes in traversal order. When a node's box is missed, the traversal continues at `skip`.
struct TreeNode {
    std::array<float, 3> lower{};
    std::array<float, 3> upper{};
    std::uint32_t skip = 0;
    // Leaf: index into TriangleTree::order.
    std::uint32_t first = 0;
    std::uint32_t count = 0; // 0: not a leaf
};

struct TriangleTree {
    std::vector<TreeNode> nodes;
    std::vector<std::uint32_t> order; // triangles of all leaves in order

    // Calls visit(triangle) for every triangle in a leaf whose box meets the given box.
    template <class Visit>
    void visit_box(const Vec3 &lower_m, const Vec3 &upper_m, Visit &&visit) const {
        std::size_t place = 0;
        while (place < nodes.size()) {
            const TreeNode &node = nodes[place];
            bool meets = true;
            for (int axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<std::size_t>(axis);
                meets = meets && static_cast<double>(node.lower[i]) <= upper_m[axis] &&
                        static_cast<double>(node.upper[i]) >= lower_m[axis];
            }
            if (!meets) {
                place = node.skip;
                continue;
            }
            for (std::uint32_t i = 0; i < node.count; ++i) {
                visit(order[node.first + i]);
            }
            ++place;
        }
    }
};

// Builds the tree from three indices into points per triangle. Not for the servo thread.
[[nodiscard]] TriangleTree build_tree(std::span<const Vec3> points,
                                      std::span<const std::uint32_t> indices);

} // namespace spidar
