// A tool, a scene, and a hand that holds the device anywhere.
#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "device/contact/proxy/tool_proxy.h"
#include "support/touch_scenes.h"

namespace spidar::test {

inline constexpr double kProxyTick_s = 0.001;

struct ProxyRig {
    ProxySettings settings;
    Tool tool;
    ContactScene scene;
    ProxyMemory memory;
    ToolProxy proxy;
    ToolPose device;
    std::vector<std::shared_ptr<const void>> keep;

    ProxyRig() {
        settings.damping_s = 0.0;
        proxy.configure(settings);
    }
    void add_tool(const ToolResult &made, ToolMount mount = ToolMount::grip,
                  const Placement &at = {}) {
        REQUIRE(usable(made.status));
        keep.push_back(made.tool);
        ToolPart &part = tool.parts[static_cast<std::size_t>(tool.count++)];
        part = {made.tool.get(), mount, at, tool.count};
    }
    ScenePart &add(const std::shared_ptr<const CookedShape> &shape, const Placement &at = {}) {
        keep.push_back(shape);
        ScenePart &part = scene.parts[static_cast<std::size_t>(scene.count++)];
        part.shape = shape.get();
        part.at = at;
        part.id = scene.count;
        return part;
    }
    void start_at(const ToolPose &pose) {
        proxy.configure(settings);
        device = pose;
        proxy.put(pose);
    }
    void tick(const Twist &velocity = {}) {
        proxy.update(tool, scene, device, velocity, kProxyTick_s, memory);
    }
    // The device goes there at this speed and stays.
    void move_to(const ToolPose &target, int ticks) {
        const Displacement whole = between(device, target);
        const ToolPose from = device;
        for (int i = 1; i <= ticks; ++i) {
            const double part = static_cast<double>(i) / ticks;
            device = moved(
                from, {part * whole.linear_m, part * whole.angular_rad, part * whole.grasp_rad});
            tick();
        }
        for (int i = 0; i < 20; ++i) {
            tick();
        }
    }
};

inline ToolPose at(const Vec3 &position_m) {
    ToolPose pose;
    pose.position_m = position_m;
    return pose;
}

} // namespace spidar::test
