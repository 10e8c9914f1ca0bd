// Turns the shapes of a held body into parts of the tool: convex, with rounded edges, in device
// meters. The convex hull replaces a mesh; other shapes that are not convex are left out. Main
// thread only.
#pragma once

#include <memory>
#include <vector>

#include <godot_cpp/variant/rid.hpp>

#include "device/contact/shapes/placement.h"
#include "device/contact/shapes/tool_shape.h"
#include "godot/hand/scene/box_clearance.h"
#include "godot/hand/scene/shape_shelf.h"

namespace godot {
class RigidBody3D;
}

namespace spidar {

class HeldShapes {
public:
    struct Part {
        std::shared_ptr<const ToolShape> shape;
        Placement in_body; // device meters
        TurnedBox box;     // around the shape, in the body's frame
    };

    // Called for a body that was just grasped. workspace_scale: scene meters per device meter.
    void take(godot::RigidBody3D &body, double workspace_scale);
    // Called once per tick while the body is held: adds large shapes once they are cooked.
    void update();
    void drop();

    [[nodiscard]] const std::vector<Part> &parts() const noexcept { return parts_; }
    // Box around all shapes, in the body's frame.
    [[nodiscard]] const TurnedBox &box() const noexcept { return box_; }

private:
    struct Waiting {
        std::shared_ptr<ShapeShelf::Source> source;
        Placement in_body;
        Vec3 scale{1.0};
    };
    void add(const CookedShape &shape, const Placement &in_body);
    [[nodiscard]] bool ready(const Waiting &one);

    ShapeShelf shelf_;
    std::vector<Waiting> waiting_;
    std::vector<Part> parts_;
    TurnedBox box_;
};

} // namespace spidar
