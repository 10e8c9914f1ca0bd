// The joints of the scene, and where their frames lay in the two bodies when each came into it: what an angle or a way is
// measured from. The engine does not tell that later. Scene coordinates. Main thread only.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <godot_cpp/variant/transform3d.hpp>

namespace godot {
class Joint3D;
class Node;
} // namespace godot

namespace spidar {

class SceneJoints {
public:
    struct Side {
        std::uint64_t body = 0; // instance id; 0: the world
        godot::Transform3D frame;
    };
    struct Found {
        std::uint64_t joint = 0;
        Side held;
        Side other;
        bool held_is_first = false; // Joint3D.node_a; false where the other is the world
    };

    // All that is there now.
    void read(godot::Node &root);
    // A node has come into the tree; its bodies may come after it.
    void note(godot::Node &node);
    void clear();
    // Once a physics tick.
    void update();
    // Those that tie the body, without the joints by which hands hold it.
    [[nodiscard]] std::vector<Found> of(std::uint64_t body);

private:
    struct Known {
        std::array<Side, 2> sides;
    };
    void learn(std::uint64_t joint);

    std::unordered_map<std::uint64_t, Known> known_;
    std::vector<std::uint64_t> new_;
};

} // namespace spidar
