// A renderer of shapes that is fed a pose by hand, and a game that publishes when it is told to.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <memory>

#include "device/contact/touch/touch_renderer.h"
#include "support/servo_fixture.h"
#include "support/touch_scenes.h"

namespace spidar::test {

struct TouchRig {
    ServoSettings settings;
    ProxyMemory memory;
    TouchRenderer renderer;
    GripMotion motion;
    double time_s = 0.0;
    std::uint64_t sequence = 0;
    int expired = 0;
    std::shared_ptr<TouchScene> given;

    TouchRig() {
        renderer.use(&memory);
        renderer.configure(settings);
        motion.grip.frame.rotation = Mat3(1.0);
    }
    // Taken in the next cycle. The scene is as of now.
    void give(TouchScene &touch) {
        touch.state_time_s = time_s;
        REQUIRE(usable(validate(touch)));
        given = std::make_shared<TouchScene>(touch);
    }
    Wrench tick() {
        time_s += kTick_s;
        expired += renderer.age(kTick_s) ? 1 : 0;
        if (given) {
            (void)renderer.accept(*given, ++sequence, time_s);
            given.reset();
        }
        const Wrench wrench = renderer.render(motion, kTick_s);
        renderer.integrate(1.0, kTick_s);
        return wrench;
    }
    Wrench ticks(int count) {
        Wrench last;
        for (int i = 0; i < count; ++i) {
            last = tick();
        }
        return last;
    }
    [[nodiscard]] TouchReport report() const {
        TouchReport told;
        renderer.report(told);
        return told;
    }
    [[nodiscard]] ToolPose device() const {
        return {motion.grip.pose.position_m, motion.grip.frame.rotation,
                motion.grip.frame.grasp_angle_rad};
    }
};

} // namespace spidar::test
