// Stores the joints of the scene with their frames in both bodies, as they are in the first tick
// after a joint enters the scene. The engine measures angles and distances from these frames and
// does not report them later. Scene coordinates. Main thread only.
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
        std::uint64_t body = 0;   // instance id; 0: the world
        godot::Transform3D frame; // in the body's frame
    };
    struct Found {
        std::uint64_t joint = 0;
        Side held;
        Side other;
        // True if the held body is the first of the joint's sides. The world is always the first.
        bool held_is_first = false;
    };

    // Calls note() for `root` and all nodes below.
    void read(godot::Node &root);
    // Remembers a joint for the next update(), since its bodies may enter the tree after it.
    // Ignores other nodes.
    void note(godot::Node &node);
    void clear();
    // Called once per physics tick: stores the frames of the remembered joints.
    void update();
    // Returns the joints of the body, without those below a SpidarGHand.
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
