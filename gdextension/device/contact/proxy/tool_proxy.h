// The god-object of a tool of real shapes in a scene of real shapes, in seven degrees of freedom (contact-engine of
// docs/why/contact_engine.md). The proxy follows the device as far as no surface is in its way: it never enters one, at any
// speed. The wrench is the pull of the stiffnesses from the device to the proxy, damped along the contacts, with Coulomb
// friction at each point.
//
// Once a cycle: the closest points of tool and scene at the proxy give one-sided rows n . J dq >= -gap; the nearest pose to
// the device's under all rows is the next proxy (god_object.h). A step is never longer than what the closest points
// guarantee.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "device/contact/god_object.h"
#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/joint_tie.h"
#include "device/contact/proxy/proxy_memory.h"
#include "device/contact/proxy/tool.h"
#include "device/contract/haptic_command.h"
#include "device/contract/motion.h"

namespace spidar {

// Of a contact that slides, single cycles hold, where the encoders step back: it slips until it has held for so long.
inline constexpr double kHolds_s = 0.03;

// A point where tool and scene are within the margin.
struct ProxyContact {
    std::uint8_t tool_part = 0; // place in Tool::parts and ContactScene::parts
    std::uint8_t scene_part = 0;
    std::int32_t tool_id = 0;
    std::int32_t scene_id = 0;
    std::uint32_t face = 0;
    Vec3 point_m{0.0}; // on the surface of the scene
    Vec3 normal{0.0};  // out of the scene
    double gap_m = 0.0;
    double push_n = 0.0;      // along the normal, 0 when it does not touch
    Vec3 friction_n{0.0};     // on the tool
    Vec3 stretch_m{0.0};      // of the friction's spring
    double slip_m_s = 0.0;    // along the surface; 0: its friction holds
    double held_s = kHolds_s; // since its friction gave way last, up to kHolds_s
    double slips_s = -1.0;    // for so long by now; below 0: it does not slip
    bool rubs = false;        // some contact of its pair pushes: its stretch goes on
    bool sticks = false;      // its pair has touched, and was not pulled apart since (adhesion)
    Vec3 slope{0.0};          // of a texture's height where it pushes, along the surface
    Vec3 drawn_n{0.0};        // on the tool, by texture, adhesion and magnet
};

// What it gave a part of the scene in this cycle.
struct PartForce {
    Vec3 force_n{0.0};
    Vec3 moment_nm{0.0}; // about the part's origin
};

struct ProxySettings {
    // Between device and proxy: N/m, N m/rad, N m/rad of grasp angle; each above 0.
    DofGains stiffness{1000.0, 1000.0, 1000.0, 2.0, 2.0, 2.0, 0.4};
    // Damping of each contact and of the jaws' stop, in parts of its own stiffness (unit: s), along its normal and along
    // its surface: 2 N s/m where it gives way by 1000 N/m.
    double damping_s = 0.002;
    // Surfaces nearer than this are looked at in a cycle, further where something moves: a hand at 2 m/s covers 2 mm in
    // three looks.
    double margin_m = 0.001;
};

class ToolProxy {
public:
    void configure(const ProxySettings &settings) noexcept;
    // The proxy is here: where the tool appears, in no surface.
    void put(const ToolPose &pose) noexcept;

    // The joints of a new scene, as they will be in later_s.
    void tie(const Tool &tool, double later_s) noexcept { tie_.accept(tool, later_s, pose_); }
    [[nodiscard]] const JointTie &joints() const noexcept { return tie_; }

    // One cycle of dt_s. device: filtered and predicted; velocity: of it. The scene as it was at the end of the last cycle;
    // during this one its parts move on by their velocities, and `scene` is moved on with them.
    void update(const Tool &tool, ContactScene &scene, const ToolPose &device,
                const Twist &velocity, double dt_s, ProxyMemory &memory) noexcept;

    [[nodiscard]] const ToolPose &pose() const noexcept { return pose_; }
    // On the hand.
    [[nodiscard]] const Wrench &wrench() const noexcept { return wrench_; }
    [[nodiscard]] int contact_count() const noexcept { return count_; }
    [[nodiscard]] const ProxyContact &contact(int i) const noexcept {
        return contacts_[static_cast<std::size_t>(i)];
    }
    [[nodiscard]] const std::array<PartForce, kMaxSceneParts> &given() const noexcept {
        return given_;
    }
    // The jaws' stop, N m of grasp torque: what the fingers press on each other, or on what they hold. 0 when open.
    [[nodiscard]] double stop_push_nm() const noexcept { return stop_push_nm_; }
    // Pairs whose closest points were asked for in the last cycle, and passes that it took.
    [[nodiscard]] int queries() const noexcept { return queries_; }
    [[nodiscard]] int passes() const noexcept { return passes_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept;

private:
    using Contacts = std::array<ProxyContact, kMaxPoints>;
    using Rows = std::array<ConstraintRow, kMaxRows>;
    // Of the margin, what the tool may move before the closest points are looked for again.
    static constexpr double kPartOfMargin = 0.75;
    // Normals further apart than this are of different surfaces (3e-3 rad).
    static constexpr double kTurned = 1.0 - 4.5e-6;
    static constexpr double kOpen = -1.0; // depth of a row that never pushes
    // Points of a face depend on each other: they share the push, and this part of the stiffness is lost.
    static constexpr double kRowSoftness = 1e-7;

    // Nothing is in reach: the proxy is where the device is.
    void follow(const ToolPose &device) noexcept;
    // Adds what a force on a point of the tool does to the hand, as far as the joints leave it.
    void add_force(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m, const Vec3 &force_n,
                   std::array<double, kDofCount> &sum) const noexcept;
    // Adds what joints do beside their limits.
    void add_joints(const Move &pull, const Move &pushed, const Twist &velocity) noexcept;
    [[nodiscard]] double part_at_levers(const Tool &tool, const ContactScene &scene,
                                        double all_n) const noexcept;
    // How a point of the tool moves along `direction`, in units of sqrt(energy): a row of god_object.h.
    [[nodiscard]] Move unit_move(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m,
                                 const Vec3 &direction) const noexcept;
    // How far to look at a part.
    [[nodiscard]] double look_m(const ScenePart &part, double margin_m) const noexcept {
        return has_traits_ ? std::max(margin_m, reach_m(part.traits)) : margin_m;
    }
    // How far to look in a cycle: the tool may move by kPartOfMargin of it, and what moves comes nearer meanwhile.
    [[nodiscard]] double margin_for(const ContactScene &scene, double dt_s) const noexcept;
    void find_contacts(const Tool &tool, const ContactScene &scene, double margin_m,
                       ProxyMemory &memory) noexcept;
    void offer(const ProxyContact &contact) noexcept;
    [[nodiscard]] Move scaled(const Displacement &by) const noexcept;
    [[nodiscard]] Displacement unscaled(const Move &move) const noexcept;
    // The target moved by the pushes of the rows: as near to it as they let.
    [[nodiscard]] Move nearest_to(const Move &target, const Rows &rows,
                                  const RowPushes<kMaxRows> &pushes) const noexcept;
    // No point of the tool moves further than this.
    [[nodiscard]] double length_of(const Move &move, const Tool &tool) const noexcept;
    // What breaks no row and is no longer than most_m, as near to `step` as can be told. least: what the proxy must move
    // along each row.
    [[nodiscard]] Move shortened(const Move &step, const std::array<double, kMaxRows> &least,
                                 const Tool &tool, double most_m) const noexcept;
    // True: another look from where the proxy is now may bring it nearer to the device.
    // margin_m: that of find_contacts(). dt_s: of the scene's motion that is still to come.
    bool step_towards(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                      double margin_m, double dt_s, ProxyMemory &memory) noexcept;
    // The pushes of rows_, over seams.
    [[nodiscard]] RowPushes<kMaxRows> solve_over_seams(const Tool &tool, const ContactScene &scene,
                                                       double margin_m, double dt_s,
                                                       ProxyMemory &memory) noexcept;
    // Opens the rows that push and belong to an edge flush with what the tool rests on. False: there is none.
    bool open_seams(const Tool &tool, const ContactScene &scene, const RowPushes<kMaxRows> &solved,
                    double margin_m, double dt_s, ProxyMemory &memory) noexcept;
    [[nodiscard]] bool is_flush(const ProxyContact &edge, const ProxyContact &floor,
                                const Tool &tool, const ContactScene &scene, double margin_m,
                                double dt_s, ProxyMemory &memory) noexcept;
    void push(const Tool &tool, const ContactScene &scene, const ToolPose &device,
              const Twist &velocity, double dt_s) noexcept;
    void rub(const Tool &tool, const ContactScene &scene, const ToolPose &device,
             const Twist &velocity, double dt_s) noexcept;
    // Of the same pair, in the last cycle, on a surface turned little; null: none. touching: that pushed, or that rubs.
    [[nodiscard]] const ProxyContact *nearest_before(const ProxyContact &contact,
                                                     bool touching) const noexcept;
    [[nodiscard]] bool pair_pushes(const ProxyContact &contact) const noexcept;
    // Goes on with `slips_s`, from `before` it, and returns the coefficient of this cycle. stretch_m: of the friction's spring;
    // m_per_coefficient: where a coefficient of 1 lets it slip.
    double friction_now(ProxyContact &contact, const ScenePart &other, double before_s,
                        double stretch_m, double m_per_coefficient, double slides_m_s,
                        double dt_s) const noexcept;
    // Traits of the surfaces (tool_proxy_surface.cpp). How far off they are felt.
    [[nodiscard]] double magnet_range_m(const SurfaceTraits &traits) const noexcept;
    [[nodiscard]] double reach_m(const SurfaceTraits &traits) const noexcept;
    // Sets the contact's slope and damping along it; returns the height of the texture under it, at most 0. push_n: without the texture.
    double press_into(ProxyContact &contact, const ScenePart &other, double push_n,
                      const Vec3 &speed_m_s, double dt_s) const noexcept;
    [[nodiscard]] bool stuck_before(const ProxyContact &contact) const noexcept;
    [[nodiscard]] double attraction_n(const ProxyContact &contact,
                                      const ScenePart &other) const noexcept;
    void attract(const ContactScene &scene) noexcept;
    void act_by_traits(const Tool &tool, const ContactScene &scene) noexcept;

    ProxySettings settings_;
    Move root_{}; // of the stiffnesses
    JointTie tie_;
    Move bent_{}; // by the joints' springs and motors, in the last pass
    ToolPose pose_;
    ToolPose device_; // of the last cycle
    bool placed_ = false;
    Contacts contacts_{};
    int count_ = 0;
    Contacts before_{}; // of the last cycle
    int before_count_ = 0;
    // Of the last pass, for `contacts_`, and behind them the stop of the jaws.
    Rows rows_{};
    int row_count_ = 0;
    std::uint32_t active_mask_ = 0;
    std::uint32_t pushing_mask_ = 0;
    Wrench wrench_{};
    std::array<PartForce, kMaxSceneParts> given_{};
    double stop_push_nm_ = 0.0;
    double cycle_s_ = 0.0;
    bool idle_ = true;        // the last cycle left no contact and no force behind
    bool has_traits_ = false; // some part in this cycle
    int queries_ = 0;
    int passes_ = 0;
};

} // namespace spidar
