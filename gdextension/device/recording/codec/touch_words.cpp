#include "device/recording/codec/touch_words.h"

#include <algorithm>

#include "device/recording/codec/field_words.h"

namespace spidar {

// A failing assertion means that a struct has changed: add the field to the lists below, then
// correct the number.
static_assert(count_members<TouchScene>() == 9, "TouchScene changed: list its fields here");
static_assert(count_members<ToolJoint>() == 6, "ToolJoint changed: list its fields here");
static_assert(count_members<JointAxis>() == 7, "JointAxis changed: list its fields here");
static_assert(count_members<Tool>() == 6, "Tool changed: list its fields here");
static_assert(count_members<Jaws>() == 2, "Jaws changed: list its fields here");
static_assert(count_members<ToolPart>() == 5, "ToolPart changed: list its fields here");
static_assert(count_members<ScenePart>() == 13, "ScenePart changed: list its fields here");
static_assert(count_members<SurfaceTraits>() == 6, "SurfaceTraits changed: list its fields here");
static_assert(count_members<SurfaceTexture>() == 4, "SurfaceTexture changed: list its fields here");

namespace {

template <typename Place, typename Visit>
void visit_placement(Place &at, Visit &&visit) {
    visit_vector("origin_m", 0, at.origin_m, visit);
    visit_matrix("rotation", 0, at.rotation, visit);
}

// Fields besides the parts.
template <typename Touch, typename Visit>
void visit_head(Touch &touch, Visit &&visit) {
    visit("tool.count", 0, touch.tool.count);
    visit("jaws.open_m", 0, touch.tool.jaws.open_m);
    visit("jaws.closed_rad", 0, touch.tool.jaws.closed_rad);
    visit("stop_rad", 0, touch.tool.stop_rad);
    visit("scene.count", 0, touch.scene.count);
    visit("joint_count", 0, touch.tool.joint_count);
    visit_array("stiffness", touch.stiffness, visit);
    visit("damping_n_s_m", 0, touch.damping_n_s_m);
    visit_vector("load.force_n", 0, touch.load.force_n, visit);
    visit_vector("load.moment_nm", 0, touch.load.moment_nm, visit);
    visit("load.grasp_torque_nm", 0, touch.load.grasp_torque_nm);
    visit("felt", 0, touch.felt);
    visit("state_time_s", 0, touch.state_time_s);
}

template <typename Part, typename Visit>
void visit_part(Part &part,
                Visit &&visit) requires std::is_same_v<std::remove_const_t<Part>, ToolPart> {
    visit("shape", 0, part.shape);
    visit("mount", 0, part.mount);
    visit_placement(part.at, visit);
    visit("id", 0, part.id);
    visit("groups", 0, part.groups);
}

template <typename Part, typename Visit>
void visit_part(Part &part,
                Visit &&visit) requires std::is_same_v<std::remove_const_t<Part>, ScenePart> {
    visit("shape", 0, part.shape);
    visit_placement(part.at, visit);
    visit_vector("velocity_m_s", 0, part.velocity_m_s, visit);
    visit_vector("angular_rad_s", 0, part.angular_rad_s, visit);
    visit_vector("belt_m_s", 0, part.belt_m_s, visit);
    visit_vector("belt_rad_s", 0, part.belt_rad_s, visit);
    visit("stiffness_n_m", 0, part.stiffness_n_m);
    visit("stiffness_at_once", 0, part.stiffness_at_once);
    visit("damping_n_s_m", 0, part.damping_n_s_m);
    visit("friction", 0, part.friction);
    visit("static_friction", 0, part.traits.static_friction);
    visit("catches_again", 0, part.traits.catches_again);
    visit("adhesion_n", 0, part.traits.adhesion_n);
    visit("magnet_n", 0, part.traits.magnet_n);
    visit("magnet_range_m", 0, part.traits.magnet_range_m);
    visit("texture.wavelength_m", 0, part.traits.texture.wavelength_m);
    visit("texture.depth_m", 0, part.traits.texture.depth_m);
    visit_vector("texture.across", 0, part.traits.texture.across, visit);
    visit("texture.relief", 0, part.traits.texture.relief);
    visit("id", 0, part.id);
    visit("groups", 0, part.groups);
}

template <typename Part, typename Visit>
void visit_part(Part &part,
                Visit &&visit) requires std::is_same_v<std::remove_const_t<Part>, ToolJoint> {
    visit("id", 0, part.id);
    visit_placement(part.base, visit);
    visit_vector("velocity_m_s", 0, part.velocity_m_s, visit);
    visit_vector("angular_rad_s", 0, part.angular_rad_s, visit);
    visit_placement(part.in_grip, visit);
    for (auto &axis : part.axes) {
        visit("lower", 0, axis.lower);
        visit("upper", 0, axis.upper);
        visit("stiffness", 0, axis.stiffness);
        visit("rest", 0, axis.rest);
        visit("damping", 0, axis.damping);
        visit("motor_speed", 0, axis.motor_speed);
        visit("motor_most", 0, axis.motor_most);
    }
}

template <typename VisitAll>
std::size_t count_visits(VisitAll &&visit_all) noexcept {
    std::size_t count = 0;
    visit_all([&count](std::string_view, int, const auto &) { ++count; });
    return count;
}

// Number of words per part of a scene; the first word of a scene is 1 when there is one.
struct Layout {
    std::size_t head = 0;
    std::size_t tool_part = 0;
    std::size_t scene_part = 0;
    std::size_t joint = 0;

    [[nodiscard]] std::size_t first_scene_part() const noexcept {
        return head + kMaxToolParts * tool_part;
    }
    [[nodiscard]] std::size_t first_joint() const noexcept {
        return first_scene_part() + kMaxSceneParts * scene_part;
    }
};
const Layout &layout() noexcept {
    static const Layout sizes = [] {
        const TouchScene touch;
        const ToolPart tool;
        const ScenePart part;
        const ToolJoint joint;
        return Layout{1 + count_visits([&](auto &&visit) { visit_head(touch, visit); }),
                      count_visits([&](auto &&visit) { visit_part(tool, visit); }),
                      count_visits([&](auto &&visit) { visit_part(part, visit); }),
                      count_visits([&](auto &&visit) { visit_part(joint, visit); })};
    }();
    return sizes;
}

template <typename Shape>
std::uint64_t word_of(const Shape *shape) noexcept {
    return shape != nullptr ? shape->number() : 0;
}
template <typename T>
std::uint64_t word_of(const T &value) noexcept {
    return to_word(value);
}

// Visits the first `count` parts, each from its own index on.
template <typename Parts, typename Use>
void for_parts(Parts &parts, int count, std::size_t first, std::size_t words_each, Use &&use) {
    const int most = static_cast<int>(parts.size());
    for (int i = 0; i < std::clamp(count, 0, most); ++i) {
        const auto k = static_cast<std::size_t>(i);
        use(parts[k], first + k * words_each);
    }
}

// Visits all fields of a scene's existing parts, with the indices of their words.
template <typename Touch, typename Visit>
void visit_parts(Touch &touch, Visit &&visit) noexcept {
    const Layout &sizes = layout();
    const auto visit_from = [&visit](auto &part, std::size_t place) {
        visit_part(part, [&](std::string_view, int, auto &field) { visit(place++, field); });
    };
    for_parts(touch.tool.parts, touch.tool.count, sizes.head, sizes.tool_part, visit_from);
    for_parts(touch.scene.parts, touch.scene.count, sizes.first_scene_part(), sizes.scene_part,
              visit_from);
    for_parts(touch.tool.joints, touch.tool.joint_count, sizes.first_joint(), sizes.joint,
              visit_from);
}

} // namespace

std::size_t count_touch_words() noexcept {
    const Layout &sizes = layout();
    return sizes.first_joint() + kMaxToolJoints * sizes.joint;
}

void store_touch(const TouchScene *touch, std::span<std::uint64_t> words) noexcept {
    words[0] = touch != nullptr ? 1 : 0;
    if (touch == nullptr) {
        return;
    }
    std::size_t next = 1;
    visit_head(*touch,
               [&](std::string_view, int, const auto &field) { words[next++] = to_word(field); });
    visit_parts(*touch,
                [&](std::size_t place, const auto &field) { words[place] = word_of(field); });
}

bool load_touch(std::span<const std::uint64_t> words, const RecordedShapes &shapes,
                TouchScene &touch) noexcept {
    touch = TouchScene();
    if (words[0] == 0) {
        return false;
    }
    std::size_t next = 1;
    visit_head(touch, [&](std::string_view, int, auto &field) { from_word(words[next++], field); });
    visit_parts(touch, [&](std::size_t place, auto &field) {
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, const CookedShape *>) {
            field = shapes.shape(words[place]);
        } else if constexpr (std::is_same_v<Field, const ToolShape *>) {
            field = shapes.tool(words[place]);
        } else {
            from_word(words[place], field);
        }
    });
    return true;
}

} // namespace spidar
