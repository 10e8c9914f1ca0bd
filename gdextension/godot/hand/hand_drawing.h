// Lines in the scene that show what a hand works with: the shapes in its reach, where it touches them and with which force,
// the tool's proxy and the device. Main thread only.
#pragma once

#include <vector>

#include <godot_cpp/classes/immediate_mesh.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/color.hpp>

#include "device/contact/proxy/tool.h"
#include "device/contract/servo_snapshot.h"
#include "godot/base/world_frame.h"
#include "godot/hand/scene/surroundings.h"

namespace godot {
class MeshInstance3D;
}

namespace spidar {

class HandDrawing {
public:
    // Makes its mesh, an internal child of `hand`, when there is none.
    void draw(godot::Node3D &hand, const WorldFrame &frame, const std::vector<NearShape> &shapes,
              const TouchReport &touch, const ToolPose &proxy, const ToolPose &device,
              const Jaws &jaws);
    void hide();

private:
    void prepare(godot::Node3D &hand);
    void line(const Vec3 &from_m, const Vec3 &to_m, const godot::Color &colour);
    void box(const Placement &at, const Vec3 &lower_m, const Vec3 &upper_m,
             const godot::Color &colour);
    void tool(const ToolPose &pose, const Jaws &jaws, const godot::Color &colour);

    godot::MeshInstance3D *instance_ = nullptr; // owned by the hand
    godot::Ref<godot::ImmediateMesh> mesh_;
    WorldFrame frame_;
    bool shown_ = false;
};

} // namespace spidar
