// The tool in seven degrees of freedom: parts that ride on the grip or on one of its two jaws. Device frame, SI.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "device/contact/proxy/tool_joint.h"
#include "device/contact/shapes/placement.h"
#include "device/contact/shapes/tool_shape.h"
#include "device/contract/motion.h"

namespace spidar {

// Position, rotation and grasp angle: what contacts act on. The tool's proxy has one, and the device.
struct ToolPose {
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_rad = 0.0;
};
[[nodiscard]] ToolPose moved(const ToolPose &pose, const Displacement &by) noexcept;
// The move from one to the other: moved(from, between(from, to)) is `to`, for turns below half a turn.
[[nodiscard]] Displacement between(const ToolPose &from, const ToolPose &to) noexcept;

// grip: turns with the grip. The jaws slide along the grip's x axis as the grasp angle closes them.
enum class ToolMount : std::uint8_t { grip = 0, jaw_minus = 1, jaw_plus = 2 };

// The gap between the jaws' inner faces: open_m at a grasp angle of 0, nothing at closed_rad, and linear everywhere. The
// tool's stop keeps a proxy from closing further (Tool::closes_to_rad).
struct Jaws {
    double open_m = 0.08;
    double closed_rad = 0.87;

    [[nodiscard]] double gap_m(double grasp_rad) const noexcept {
        return open_m * (1.0 - grasp_rad / closed_rad);
    }
    // d(gap) / d(grasp angle). The same at the stop: there the jaws may still open.
    [[nodiscard]] double slope_m_rad() const noexcept { return -open_m / closed_rad; }
};

// Parts of a tool and of a scene touch when they share a bit: pads and a held body may collide with different things.
inline constexpr std::uint8_t kPadGroup = 1;
inline constexpr std::uint8_t kHeldGroup = 2;
inline constexpr std::uint8_t kAllGroups = 0xff;

// What moves on for dt_s at these velocities, that of its origin and its turn's.
void carry_on(Placement &at, const Vec3 &velocity_m_s, const Vec3 &angular_rad_s,
              double dt_s) noexcept;

struct ToolPart {
    const ToolShape *shape = nullptr;
    ToolMount mount = ToolMount::grip;
    Placement at; // in the grip's frame from P0; on a jaw: from the middle of its inner face
    std::int32_t id = 0;
    std::uint8_t groups = kAllGroups; // of the scene's parts, those that it touches
};

inline constexpr int kMaxToolParts = 16;
struct Tool {
    std::array<ToolPart, kMaxToolParts> parts{};
    int count = 0;
    Jaws jaws;
    // The jaws close no further than this, nor beyond jaws.closed_rad: on what they hold.
    double stop_rad = std::numeric_limits<double>::infinity();
    // What ties what it holds to something else.
    std::array<ToolJoint, kMaxToolJoints> joints{};
    int joint_count = 0;

    [[nodiscard]] double closes_to_rad() const noexcept {
        return std::min(stop_rad, jaws.closed_rad);
    }
};

[[nodiscard]] Placement placement_of(const ToolPart &part, const Jaws &jaws,
                                     const ToolPose &pose) noexcept;

// How a point fixed to the part, at point_m, moves along `direction` with the tool: d(direction . point) for one metre, one
// radian of turn, one radian of grasp. By the same numbers a force along `direction` at the point acts on the tool.
[[nodiscard]] Displacement moves_along(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                                       const Vec3 &point_m, const Vec3 &direction) noexcept;
// Velocity of that point when the tool moves by this twist.
[[nodiscard]] Vec3 point_velocity(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                                  const Twist &twist, const Vec3 &point_m) noexcept;

} // namespace spidar
