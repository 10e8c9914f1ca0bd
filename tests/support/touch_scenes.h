// Scenes of real shapes for tests of the servo loop.
#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

#include "device/contact/touch/touch_scene.h"
#include "support/shape_samples.h"

namespace spidar::test {

// Solid below y = 0.
inline ShapePtr cooked_half_space() {
    return half_space(Vec3(0.0, 1.0, 0.0), 0.0);
}

// Adds a shape to a scene, which keeps it.
inline ScenePart &add(TouchScene &touch, const std::shared_ptr<const CookedShape> &shape,
                      const Placement &at = {}) {
    touch.shapes.push_back(shape);
    ScenePart &part = touch.scene.parts[static_cast<std::size_t>(touch.scene.count++)];
    part = ScenePart();
    part.shape = shape.get();
    part.at = at;
    part.id = touch.scene.count;
    return part;
}

inline ToolPart &add_tool(TouchScene &touch, const ToolResult &made,
                          ToolMount mount = ToolMount::grip, const Placement &at = {}) {
    if (!usable(made.status)) {
        throw std::runtime_error(made.sentence);
    }
    touch.tool_shapes.push_back(made.tool);
    ToolPart &part = touch.tool.parts[static_cast<std::size_t>(touch.tool.count++)];
    part = ToolPart();
    part.shape = made.tool.get();
    part.mount = mount;
    part.at = at;
    part.id = touch.tool.count;
    return part;
}

inline constexpr double kBall_m = 0.012;

// A ball at the grip's centre and a floor whose surface is at height_m: its normal is +y.
struct FloorScene {
    TouchScene touch;
    explicit FloorScene(double height_m = 0.0, double stiffness_n_m = 0.0) {
        add_tool(touch, make_sphere(kBall_m));
        add(touch, cooked_half_space(), {Vec3(0.0, height_m, 0.0), Mat3(1.0)});
        for (std::size_t dof = 0; dof < 3; ++dof) {
            touch.stiffness[dof] = stiffness_n_m;
        }
    }
};

} // namespace spidar::test
