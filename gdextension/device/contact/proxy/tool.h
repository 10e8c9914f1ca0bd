// The tool, which moves in seven DOF: shapes on the grip or on one of its two jaws. Device frame,
// SI units.
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

// Position, rotation and grasp angle of the device or of the tool's proxy.
struct ToolPose {
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_rad = 0.0;
};
[[nodiscard]] ToolPose moved(const ToolPose &pose, const Displacement &by) noexcept;
// Returns the displacement between poses less than half a turn apart: moved(from, result) = to.
[[nodiscard]] Displacement between(const ToolPose &from, const ToolPose &to) noexcept;

// Where a part is mounted. grip: fixed to the grip. jaw_minus, jaw_plus: on the jaw at the -x or +x
// side of the grip, which slides along the grip's x axis when the grasp angle changes.
enum class ToolMount : std::uint8_t { grip = 0, jaw_minus = 1, jaw_plus = 2 };

// The gap between the jaws' inner faces is open_m at grasp angle 0 and 0 at closed_rad. It is
// linear in the grasp angle, also beyond; Tool::closes_to_rad() limits the closing.
struct Jaws {
    double open_m = 0.08;
    double closed_rad = 0.87;

    [[nodiscard]] double gap_m(double grasp_rad) const noexcept {
        return open_m * (1.0 - grasp_rad / closed_rad);
    }
    // Returns d(gap) / d(grasp angle), which is the same at every angle.
    [[nodiscard]] double slope_m_rad() const noexcept { return -open_m / closed_rad; }
};

// Collision groups. A tool part and a scene part can touch only if their groups share a bit, so
// that pads and a held body may collide with different objects.
inline constexpr std::uint8_t kPadGroup = 1;
inline constexpr std::uint8_t kHeldGroup = 2;
inline constexpr std::uint8_t kAllGroups = 0xff;

// Moves a placement for dt_s by the velocity of its origin and its angular velocity.
void carry_on(Placement &at, const Vec3 &velocity_m_s, const Vec3 &angular_rad_s,
              double dt_s) noexcept;

struct ToolPart {
    const ToolShape *shape = nullptr;
    ToolMount mount = ToolMount::grip;
    // In the grip's frame, relative to P0; on a jaw, relative to the center of the jaw's inner
    // face.
    Placement at;
    std::int32_t id = 0;
    // Collision groups, as above.
    std::uint8_t groups = kAllGroups;
};

inline constexpr int kMaxToolParts = 16;
struct Tool {
    std::array<ToolPart, kMaxToolParts> parts{};
    int count = 0;
    Jaws jaws;
    // Largest grasp angle, as set by a held body; jaws.closed_rad limits the grasp angle too.
    double stop_rad = std::numeric_limits<double>::infinity();
    // Joints that tie the held body to something else.
    std::array<ToolJoint, kMaxToolJoints> joints{};
    int joint_count = 0;

    [[nodiscard]] double closes_to_rad() const noexcept {
        return std::min(stop_rad, jaws.closed_rad);
    }
};

[[nodiscard]] Placement placement_of(const ToolPart &part, const Jaws &jaws,
                                     const ToolPose &pose) noexcept;

// Returns how a point fixed to the part moves along `direction` with the tool: d(direction . point)
// per meter, per radian of turn, per radian of grasp. The same numbers convert a force along
// `direction` at the point to the tool's wrench.
[[nodiscard]] Displacement moves_along(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                                       const Vec3 &point_m, const Vec3 &direction) noexcept;
// Returns the velocity of a point fixed to the part when the tool moves with this twist.
[[nodiscard]] Vec3 point_velocity(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                                  const Twist &twist, const Vec3 &point_m) noexcept;

} // namespace spidar
