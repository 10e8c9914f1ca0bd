// Joints and materials of any values at all: the proxy stays finite, and what the hand feels is bounded.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"
#include "support/case_random.h"
#include "support/proxy_rig.h"
#include "support/relief_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// From nothing to `most`, by powers of ten.
double any_size(CaseRandom &random, double most = 1e6) {
    return random.between(0.0, 1.0) < 0.2 ? 0.0 : random.spread(1e-6, most);
}

JointAxis any_axis(CaseRandom &random, double most) {
    JointAxis axis;
    const double kind = random.between(0.0, 1.0);
    axis.lower = kind < 0.4 ? 0.0 : random.between(-0.5, 0.5);
    axis.upper = kind < 0.4 ? 0.0 : random.between(-0.5, 0.5);
    if (random.between(0.0, 1.0) < 0.5) {
        axis.stiffness = any_size(random, most);
        axis.rest = random.between(-1.0, 1.0);
        axis.damping = any_size(random, most);
    }
    if (random.between(0.0, 1.0) < 0.3) {
        axis.motor_speed = random.between(-10.0, 10.0);
        axis.motor_most = any_size(random, most);
    }
    return axis;
}

SurfaceTraits any_traits(CaseRandom &random) {
    SurfaceTraits traits;
    traits.static_friction = std::min(any_size(random), 3.0); // the renderer's cap
    traits.catches_again = random.between(0.0, 1.0) < 0.5;
    traits.adhesion_n = std::min(any_size(random), 20.0);
    traits.magnet_n = std::min(any_size(random), 20.0);
    traits.magnet_range_m = std::min(any_size(random), 1.0);
    traits.texture = {any_size(random) + 1e-9, any_size(random),
                      random.between(0.0, 1.0) < 0.5
                          ? Vec3(0.0)
                          : glm::normalize(random.vector(1.0) + Vec3(1e-6))};
    return traits;
}

} // namespace

TEST_CASE("proxy: joints and materials of any size give finite forces, within what pulls") {
    const ShapePtr relief = cooked(relief_noise(32, 16, 9));
    constexpr int kScenes = 300;
    constexpr int kTicks = 120;
    for (int scene = 0; scene < kScenes; ++scene) {
        CaseRandom random(11, static_cast<std::uint64_t>(scene));
        const bool absurd = scene % 2 == 0;
        CAPTURE(scene);
        ProxyRig rig;
        rig.settings.damping_s = 0.0018;
        rig.add_tool(make_sphere(0.01));
        rig.add_tool(make_tool(*box(Vec3(0.01))), ToolMount::grip,
                     {Vec3(0.0, -0.02, 0.0), Mat3(1.0)});
        for (int i = 0; i < 3; ++i) {
            ScenePart &part = rig.add(i == 0 ? cooked_half_space() : box(Vec3(0.02)),
                                      {random.vector(0.04), random.rotation(3.0)});
            part.friction = std::min(any_size(random), 3.0);
            part.stiffness_n_m = any_size(random);
            part.damping_n_s_m = std::min(any_size(random), 5.0);
            part.traits = any_traits(random);
            part.traits.texture.relief = (scene + i) % 3 == 0 ? relief.get() : nullptr;
        }
        rig.tool.joint_count = static_cast<int>(random.between(0.0, kMaxToolJoints + 0.99));
        for (int j = 0; j < rig.tool.joint_count; ++j) {
            ToolJoint &joint = rig.tool.joints[static_cast<std::size_t>(j)];
            joint.id = j + 1;
            joint.base = {random.vector(0.1), random.rotation(3.0)};
            joint.in_grip = {random.vector(0.1), random.rotation(3.0)};
            joint.velocity_m_s = random.vector(0.2);
            joint.angular_rad_s = random.vector(1.0);
            for (JointAxis &axis : joint.axes) {
                axis = any_axis(random, absurd ? 1e6 : 100.0);
            }
        }
        rig.start_at(at(random.vector(0.05)));
        for (int tick = 0; tick < kTicks; ++tick) {
            if (tick % 16 == 0) {
                for (ToolJoint &joint : rig.tool.joints) {
                    joint.base.origin_m += random.vector(0.001);
                }
                rig.proxy.tie(rig.tool, 0.0);
            }
            const Vec3 speed_m_s = random.vector(0.5);
            rig.device.position_m += kProxyTick_s * speed_m_s;
            rig.device.rotation = random.rotation(0.002) * rig.device.rotation;
            rig.tick({speed_m_s, random.vector(2.0), 0.0});
            const Wrench &felt = rig.proxy.wrench();
            CHECK(all_finite(felt.force_n, felt.moment_nm, felt.grasp_torque_nm));
            CHECK(all_finite(rig.proxy.pose().position_m, rig.proxy.pose().rotation));
            // The device's springs over what they are stretched by, and contacts and attraction; joints that contradict
            // each other with springs and motors of a million newtons are bounded by the device's limits alone.
            const double stretched_m =
                glm::distance(rig.proxy.pose().position_m, rig.device.position_m);
            const double usual_n = 3.0 * rig.settings.stiffness[0] * (stretched_m + 0.02) + 1000.0;
            const double most_n = absurd ? 1e5 : usual_n;
            CHECK(glm::length(felt.force_n) < most_n);
        }
    }
}
