// Draws lines into the scene for debugging a hand: shapes in reach, contacts with their forces, and
// the tool at the proxy's and at the device's pose. A line has the same width on the screen at any
// distance; parts behind other objects are pale. Main thread only.
#pragma once

#include <vector>

#include <godot_cpp/classes/immediate_mesh.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/color.hpp>

#include "device/contact/proxy/tool.h"
#include "device/contract/servo_snapshot.h"
#include "godot/base/world_frame.h"
#include "godot/hand/grasp/held_shapes.h"
#include "godot/hand/scene/surroundings.h"

namespace godot {
class MeshInstance3D;
}

namespace spidar {

// What to draw in a tick. Device frame.
struct HandPicture {
    WorldFrame frame;
    const std::vector<NearShape> &shapes;
    const TouchReport &touch;
    ToolPose proxy;
    ToolPose device;
    Jaws jaws;
    const std::vector<HeldShapes::Part> &held; // empty while nothing is held
    Placement in_grip;                         // pose of the held body in the grip
};

class HandDrawing {
public:
    // Draws into a mesh on an internal child of `hand`, which the first call creates.
    void draw(godot::Node3D &hand, const HandPicture &picture);
    void hide();

private:
    struct Pen {
        godot::Color color;
        // Width at a viewport height of at most 720 pixels; proportional to a larger height.
        double width_px;
    };

    void prepare(godot::Node3D &hand);
    void line(const Vec3 &from_m, const Vec3 &to_m, const Pen &pen);
    void lines(const Placement &at, const std::vector<Vec3> &ends_m, const Pen &pen);
    void ring(const Placement &at, double radius_m, const Pen &pen); // about the x axis of `at`
    void arrow(const Vec3 &from_m, const Vec3 &along_m, const Pen &pen);
    void shapes(const HandPicture &picture);
    void tool(const ToolPose &pose, const Jaws &jaws, const Pen &pen);
    void points(const TouchReport &touch);

    static const Pen kByPads;
    static const Pen kByHeld;
    static const Pen kProxy;
    static const Pen kDevice;
    static const Pen kForce;
    static const Pen kNormal;

    godot::MeshInstance3D *instance_ = nullptr; // owned by the hand
    godot::Ref<godot::ImmediateMesh> mesh_;
    std::vector<Vec3> ends_m_; // ends of the lines of one outline
    WorldFrame frame_;
    bool shown_ = false;
};

} // namespace spidar
