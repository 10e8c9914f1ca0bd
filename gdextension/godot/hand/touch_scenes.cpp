#include "godot/hand/touch_scenes.h"

#include <algorithm>
#include <limits>

#include "device/contract/dof_lanes.h"
#include "device/settings/gain_clamp.h"
#include "godot/hand/grasp/pinch.h"

namespace spidar {

namespace {

// Stiffness across the jaws, relative to the usual one, with which the pads center themselves:
// fingers that squeeze with 0.6 N overcome it 6 mm beside the middle.
constexpr double kCentringPart = 0.1;
constexpr double kSoftestSqueeze_nm_rad = 0.02;
constexpr double kFirmestSqueeze_nm_rad = 0.4;

DofGains stiffness_of(const HandFeel &feel, const ServoSettings &settings) noexcept {
    DofGains stiffness{};
    const GainCaps caps = gain_caps(settings.render, settings.rate_hz);
    // A chosen stiffness keeps the proportions of the automatic ones.
    const double share =
        feel.stiffness_n_m > 0.0 ? feel.stiffness_n_m / stiffness_cap(caps, 0).most : 0.0;
    for (std::size_t dof = 0; dof < stiffness.size(); ++dof) {
        stiffness[dof] = share * stiffness_cap(caps, dof).most;
    }
    const auto own = [&](std::size_t dof) {
        return share > 0.0 ? stiffness[dof] : kAutomaticShare * stiffness_cap(caps, dof).most;
    };
    if (feel.centres_itself) {
        for (std::size_t dof = 0; dof < 3; ++dof) {
            stiffness[dof] = kCentringPart * own(dof);
        }
    }
    if (feel.squeeze_nm_rad > 0.0) {
        stiffness[kGraspLane] =
            std::min(own(kGraspLane), std::clamp(feel.squeeze_nm_rad, kSoftestSqueeze_nm_rad,
                                                 kFirmestSqueeze_nm_rad));
    }
    return stiffness;
}

// Returns the stiffness of a surface; 0: rigid.
double softness_of(const NearShape &shape, const HandFeel &feel) noexcept {
    const double own_n_m = shape.facts.stiffness_n_m;
    const bool is_pinched = static_cast<std::uint64_t>(shape.body.get_id()) == feel.pinched;
    const double pushed_n_m = is_pinched ? 0.0 : feel.pushed_n_m_kg * shape.mass_kg;
    return own_n_m > 0.0 && pushed_n_m > 0.0 ? std::min(own_n_m, pushed_n_m)
                                             : std::max(own_n_m, pushed_n_m);
}

void add_scene(const std::vector<NearShape> &near, const HandFeel &feel, TouchScene &touch) {
    for (const NearShape &shape : near) {
        if (touch.scene.count == kMaxSceneParts) {
            return;
        }
        ScenePart &part = touch.scene.parts[static_cast<std::size_t>(touch.scene.count++)];
        part.shape = shape.shape.get();
        part.at = shape.at;
        part.velocity_m_s = shape.velocity_m_s;
        part.angular_rad_s = shape.angular_rad_s;
        part.belt_m_s = shape.belt_m_s;
        part.belt_rad_s = shape.belt_rad_s;
        part.stiffness_n_m = softness_of(shape, feel);
        part.stiffness_at_once = feel.pushed_n_m_kg > 0.0 && shape.mass_kg > 0.0;
        part.damping_n_s_m = shape.facts.damping_n_s_m;
        part.friction = shape.facts.slipping_friction(feel.friction);
        part.traits = shape.traits;
        part.id = shape.id;
        part.groups = shape.seen_by;
        touch.shapes.push_back(shape.shape);
        if (part.traits.texture.relief != nullptr) {
            touch.shapes.push_back(shape.facts.relief);
        }
    }
}

// Returns a lower bound of each held shape's distance from the scene; only the nearest ones fit
// into the tool.
std::vector<std::size_t> nearest_first(const HeldTool &held, const std::vector<NearShape> &near) {
    std::vector<std::size_t> order(held.parts.size());
    std::vector<double> gaps(held.parts.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
        TurnedBox mine = held.parts[i].box;
        mine.at = held.grip * held.in_grip * mine.at;
        for (const NearShape &shape : near) {
            if ((shape.seen_by & kSeenByHeld) != 0 &&
                shape.shape->kind() != ShapeKind::half_space) {
                const Vec3 lower = shape.shape->lower_m();
                const Vec3 upper = shape.shape->upper_m();
                const TurnedBox other{shape.at * Placement{0.5 * (lower + upper), Mat3(1.0)},
                                      0.5 * (upper - lower)};
                gaps[i] = std::min(gaps[i], clearance(mine, other));
            }
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&gaps](std::size_t a, std::size_t b) { return gaps[a] < gaps[b]; });
    return order;
}

} // namespace

static_assert(kSeenByPads == kPadGroup && kSeenByHeld == kHeldGroup);
static_assert(kMostNearShapes <= kMaxSceneParts);

std::shared_ptr<TouchScene> make_touch_scene(const Pads &pads, const Jaws &jaws,
                                             const std::vector<NearShape> &near,
                                             const HeldTool *held, const HandFeel &feel,
                                             const ServoSettings &settings, const Wrench &load) {
    auto touch = std::make_shared<TouchScene>();
    touch->tool = pads.tool(jaws);
    touch->tool_shapes.push_back(pads.shape());
    add_scene(near, feel, *touch);
    if (held != nullptr) {
        touch->tool.stop_rad = held->stop_rad;
        std::vector<std::size_t> order(held->parts.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        constexpr std::size_t kRoom = kMaxToolParts - 2;
        if (order.size() > kRoom) {
            order = nearest_first(*held, near);
            order.resize(kRoom);
        }
        for (const std::size_t index : held->is_detained ? std::vector<std::size_t>() : order) {
            ToolPart &part = touch->tool.parts[static_cast<std::size_t>(touch->tool.count++)];
            part.shape = held->parts[index].shape.get();
            part.mount = ToolMount::grip;
            part.at = held->in_grip * held->parts[index].in_body;
            part.id = kFirstHeldId + static_cast<std::int32_t>(index);
            part.groups = kHeldGroup;
            touch->tool_shapes.push_back(held->parts[index].shape);
        }
    }
    touch->stiffness = stiffness_of(feel, settings);
    touch->damping_n_s_m = feel.damping_n_s_m;
    touch->load = load;
    constexpr unsigned kLinearAndTurns = 0x3fU;
    constexpr unsigned kGrasp = 0x40U;
    touch->felt = static_cast<std::uint8_t>((feel.contacts ? kLinearAndTurns : 0U) |
                                            (feel.width ? kGrasp : 0U));
    return touch;
}

} // namespace spidar
