// The joints of the scene, with the poses of their frames in both bodies when each joint entered
// the scene. Angles and distances are measured from there, and the engine does not report them
// later. Scene coordinates. Main thread only.
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
        // The held body is Joint3D.node_a; false when the other body is the world.
        bool held_is_first = false;
    };

    // Reads all joints below `root`.
    void read(godot::Node &root);
    // Notes a node that entered the tree; its bodies may enter later.
    void note(godot::Node &node);
    void clear();
    // Called once per physics tick.
    void update();
    // Returns the joints of the body, except those by which hands hold it.
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
