// Renders shapes as a wrench in each servo cycle. A game publishes the shapes near the tool 30 to
// 144 times per second. Between two scenes, the shapes move on by their velocities and
// accelerations. Where a new scene differs from that, the difference is spread over kCrossFade_s,
// so that the hand feels no jolt. The proxy (tool_proxy.h) stops at the shapes; the hand feels the
// springs from the device to the proxy.
#pragma once

#include <array>

#include "core/base/sound_state.h"
#include "device/contact/proxy/tool_proxy.h"
#include "device/contact/touch/surface_feel.h"
#include "device/contact/touch/touch_scene.h"
#include "device/contract/game_clock.h"
#include "device/contract/motion.h"
#include "device/contract/request_fade.h"
#include "device/contract/servo_snapshot.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class TouchRenderer {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Changes the caps: for the springs to the proxy at once, for the damping of surfaces with the
    // next scene.
    void retune(const ServoSettings &settings) noexcept;
    // Sets the memory of closest points (3 MB, owned by the loop). Without it, ready() is false and
    // the caller refuses scenes.
    void use(ProxyMemory *memory) noexcept { memory_ = memory; }
    [[nodiscard]] ProxyMemory *memory() const noexcept { return memory_; }
    // Clears that memory. Called where a segment of a recording begins, since a recording does not
    // contain it.
    void forget_pairs() const noexcept {
        if (memory_ != nullptr) {
            memory_->forget();
        }
    }

    // Replaces the scene by a valid one (validate()). sequence: its number, for report(). now_s:
    // present time on the clock of TouchScene::state_time_s. Returns the first value that was
    // clamped.
    GainClamp accept(const TouchScene &touch, std::uint64_t sequence, double now_s) noexcept;
    [[nodiscard]] bool ready() const noexcept { return memory_ != nullptr; }
    // Removes the scene: at once nothing is touched, and no load acts.
    void accept_nothing(std::uint64_t sequence) noexcept;
    // Ages the scene by one cycle; called before accept(). Returns true in the cycle in which it
    // expires.
    bool age(double dt_s) noexcept;

    // Returns the wrench of all contacts and of the load on the grip.
    Wrench render(const GripMotion &motion, double dt_s) noexcept;
    // Adds the impulses of this cycle. scale: share of the rendered wrench that was requested from
    // the strings.
    void integrate(double scale, double dt_s) noexcept;

    void report(TouchReport &report) const noexcept;
    [[nodiscard]] bool at_rest() const noexcept {
        return scene_.count == 0 && !loaded_ && tool_.joint_count == 0 &&
               !(proxy_.stop_push_nm() > 0.0);
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept;

    // Sets all pointers after the state was restored from a recording. shape_of, tool_of: functions
    // that return the shape with a number, or null. Returns false when a shape is missing or of the
    // wrong kind.
    template <typename ShapeOf, typename ToolOf>
    [[nodiscard]] bool relink(ProxyMemory *memory, ShapeOf shape_of, ToolOf tool_of) noexcept {
        memory_ = memory;
        bool found = true;
        for (int s = 0; s < scene_.count; ++s) {
            const auto k = static_cast<std::size_t>(s);
            scene_.parts[k].shape = shape_of(shape_numbers_[k]);
            found = found && scene_.parts[k].shape != nullptr;
            const CookedShape *&relief = scene_.parts[k].traits.texture.relief;
            const bool had_relief = relief_numbers_[k] != 0;
            relief = had_relief ? shape_of(relief_numbers_[k]) : nullptr;
            tracks_[k].wanted.traits.texture.relief = relief;
            found = found && !is_relief(scene_.parts[k].shape) && is_relief(relief) == had_relief;
        }
        for (int t = 0; t < tool_.count; ++t) {
            const auto k = static_cast<std::size_t>(t);
            tool_.parts[k].shape = tool_of(tool_numbers_[k]);
            found = found && tool_.parts[k].shape != nullptr;
        }
        return found;
    }

private:
    [[nodiscard]] static bool is_relief(const CookedShape *shape) noexcept {
        return shape != nullptr && shape->kind() == ShapeKind::relief;
    }
    // What the renderer keeps for each part of the scene, besides the part.
    struct Track {
        Vec3 velocity_m_s{0.0}; // velocity of the part as received, clamped
        Vec3 angular_rad_s{0.0};
        // Acceleration between the last two scenes, from their velocities.
        Vec3 seen_acceleration_m_s2{0.0};
        // Used to extrapolate: what the last two such accelerations have in common, per axis.
        Vec3 acceleration_m_s2{0.0};
        Vec3 correction_m{0.0}; // spread over kCrossFade_s
        Vec3 correction_rad{0.0};
        // Requested feel of the part, reached in feel_left_s.
        SurfaceFeel wanted;
        double feel_left_s = 0.0;
        Vec3 impulse_ns{0.0}; // on the part, since its id appeared
        Vec3 angular_impulse_nms{0.0};
    };

    // Takes the parts of a new scene. apart_s: time between the last scene and this one on the
    // game's clock; 0: unknown.
    void renew(const TouchScene &touch, double apart_s, GainClamp &clamp) noexcept;
    void drop() noexcept;
    [[nodiscard]] bool empty() const noexcept;
    // Sets the velocity of each part in this cycle. Returns false when no part moves.
    bool carry(double dt_s) noexcept;
    // Sets the wanted springs of the proxy from the requested stiffness and the caps.
    void tune(GainClamp &clamp) noexcept;
    void use_wanted_springs() noexcept;
    // Moves springs and surfaces toward their wanted values. Returns false if all had them already.
    bool approach_feel(double dt_s) noexcept;

    GainCaps caps_{};
    ProxyMemory *memory_ = nullptr;
    Tool tool_;
    ContactScene scene_;
    std::array<std::uint64_t, kMaxSceneParts>
        shape_numbers_{}; // CookedShape::number() of each part
    // Numbers of the reliefs of textures; 0: none.
    std::array<std::uint64_t, kMaxSceneParts> relief_numbers_{};
    std::array<std::uint64_t, kMaxToolParts> tool_numbers_{};
    std::array<Track, kMaxSceneParts> tracks_{};
    DofGains asked_{}; // TouchScene::stiffness
    double asked_damping_n_s_m_ = 0.0;
    ProxySettings settings_;
    // Requested springs of the proxy, reached in springs_left_s_.
    ProxySettings wanted_settings_;
    double springs_left_s_ = 0.0;
    ToolProxy proxy_;
    std::uint8_t felt_ = kAllDof;
    // The load changes gradually from load_from_ to load_; load_now_ is its present value.
    Wrench load_from_;
    Wrench load_;
    Wrench load_now_;
    double load_age_s_ = 0.0; // time since load_ arrived
    // load_ or load_from_ is not zero.
    bool loaded_ = false;
    bool settled_ = false; // the last cycle changed nothing
    std::uint64_t skipped_ = 0;
    std::uint64_t sequence_ = 0;
    // Inputs and results of the last cycle.
    double lead_s_ = 0.0;
    double cycle_s_ = 0.0;
    ToolPose device_;
    Twist velocity_;
    Wrench wrench_;
    double rendered_strength_ = 1.0;
    GameClock clock_;
    double state_time_s_ = -1.0; // of the last scene
    RefreshedStrength strength_{1.0};
};

} // namespace spidar
