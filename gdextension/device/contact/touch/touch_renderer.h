// Real shapes -> wrench, at servo rate. A game publishes what stands near the tool 30 to 144 times a second; in between
// shapes move on by their velocities, and what a new scene corrects is spread over a game frame, so that nothing reaches
// the hand as a blow. The proxy (tool_proxy.h) never enters a shape; the hand feels the spring from the device to it.
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
    // Other caps, at once.
    void retune(const ServoSettings &settings) noexcept;
    // What closest points remember from cycle to cycle, 3 MB, owned by the loop. Without it every scene is refused.
    void use(ProxyMemory *memory) noexcept { memory_ = memory; }
    [[nodiscard]] ProxyMemory *memory() const noexcept { return memory_; }
    // As if nothing had been remembered: where a recording begins, which does not hold the memory.
    void forget_pairs() const noexcept {
        if (memory_ != nullptr) {
            memory_->forget();
        }
    }

    // A valid scene replaces the last one. Says what was brought down to a cap.
    GainClamp accept(const TouchScene &touch, std::uint64_t sequence, double now_s) noexcept;
    [[nodiscard]] bool ready() const noexcept { return memory_ != nullptr; }
    // A null scene: nothing to touch and nothing to carry.
    void accept_nothing(std::uint64_t sequence) noexcept;
    // Once a cycle, before accept(). True in the cycle in which a scene is dropped for its age.
    bool age(double dt_s) noexcept;

    // The wrench of all contacts and of the load on the grip.
    Wrench render(const GripMotion &motion, double dt_s) noexcept;
    // Adds this cycle's impulses; scale: the part of the rendered wrench that is really asked of the strings.
    void integrate(double scale, double dt_s) noexcept;

    void report(TouchReport &report) const noexcept;
    [[nodiscard]] bool at_rest() const noexcept {
        return scene_.count == 0 && !loaded_ && tool_.joint_count == 0 &&
               !(proxy_.stop_push_nm() > 0.0);
    }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept;

    // A memory that comes from a recording points nowhere. shape_of, tool_of: the shape of this number, or null. False: there
    // is one that nobody has.
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
    // What a part of the scene does until the next scene comes, beside its own velocity.
    struct Track {
        Vec3 velocity_m_s{0.0}; // its own, as given
        Vec3 angular_rad_s{0.0};
        // Between the last two scenes, and what the last three agree on.
        Vec3 seen_acceleration_m_s2{0.0};
        Vec3 acceleration_m_s2{0.0};
        Vec3 correction_m{0.0}; // spread over kCrossFade_s
        Vec3 correction_rad{0.0};
        SurfaceFeel wanted; // its feel, which is reached in feel_left_s
        double feel_left_s = 0.0;
        Vec3 impulse_ns{0.0}; // on the part, since its id appeared
        Vec3 angular_impulse_nms{0.0};
    };

    // apart_s: of the game's time since the scene before; 0: unknown.
    void renew(const TouchScene &touch, double apart_s, GainClamp &clamp) noexcept;
    void drop() noexcept;
    [[nodiscard]] bool empty() const noexcept;
    // The velocities of this cycle. False: nothing moves.
    bool carry(double dt_s) noexcept;
    // The proxy's springs that are wanted, of what the game requests and what the caps allow.
    void tune(GainClamp &clamp) noexcept;
    void use_wanted_springs() noexcept;
    // Springs and surfaces on their way to what is wanted. False: they are there.
    bool approach_feel(double dt_s) noexcept;

    GainCaps caps_{};
    ProxyMemory *memory_ = nullptr;
    Tool tool_;
    ContactScene scene_;
    std::array<std::uint64_t, kMaxSceneParts> shape_numbers_{};  // CookedShape::number()
    std::array<std::uint64_t, kMaxSceneParts> relief_numbers_{}; // of textures; 0: none
    std::array<std::uint64_t, kMaxToolParts> tool_numbers_{};
    std::array<Track, kMaxSceneParts> tracks_{};
    DofGains asked_{}; // TouchScene::stiffness
    double asked_damping_n_s_m_ = 0.0;
    ProxySettings settings_;
    ProxySettings wanted_settings_; // reached in springs_left_s_
    double springs_left_s_ = 0.0;
    ToolProxy proxy_;
    std::uint8_t felt_ = kAllDof;
    Wrench load_from_; // when the scene came
    Wrench load_;
    Wrench load_now_;
    double load_age_s_ = 0.0; // since load_ came
    bool loaded_ = false;     // some load acts or is on its way to nothing
    bool settled_ = false;    // the last cycle changed nothing
    std::uint64_t skipped_ = 0;
    std::uint64_t sequence_ = 0;
    // Of the last cycle.
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
