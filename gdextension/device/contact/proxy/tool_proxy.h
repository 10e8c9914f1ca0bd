// The god-object of a tool in a scene of shapes, in seven degrees of freedom
// (docs/why/contact_engine.md). The proxy follows the device until a surface is in its way, and
// stops at the surface however fast the hand moves. The wrench is the pull of the springs from the
// device to the proxy, with damping and Coulomb friction at each contact.
//
// A cycle has one to three passes. In each, the closest points of tool and scene give one-sided
// rows n . J dq >= -gap: the move dq of the proxy may bring such a point (motion J dq) closer to
// the surface by the gap and no further. The next proxy is the pose nearest to the device under all
// rows (god_object.h). No step is longer than the search distance guarantees to be free.
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

// Time without slip after which a contact that slid counts as sticking (unit: s). A slow slide
// sticks for single cycles, whenever an encoder steps back.
inline constexpr double kHolds_s = 0.03;

// A pair of close points of a tool part and a scene part.
struct ProxyContact {
    // Indices into Tool::parts and ContactScene::parts.
    std::uint8_t tool_part = 0;
    std::uint8_t scene_part = 0;
    std::int32_t tool_id = 0;
    std::int32_t scene_id = 0;
    std::uint32_t face = 0;
    Vec3 point_m{0.0}; // on the surface of the scene
    Vec3 normal{0.0};  // out of the scene
    double gap_m = 0.0;
    double push_n = 0.0;   // along the normal; 0 without touch
    Vec3 friction_n{0.0};  // on the tool
    Vec3 stretch_m{0.0};   // of the friction spring, along the surface
    double slip_m_s = 0.0; // along the surface; 0: friction holds
    // Time since the friction last gave way, up to kHolds_s.
    double held_s = kHolds_s;
    // Time since the contact began to slide; negative: it does not slide.
    double slips_s = -1.0;
    // Time for which the friction spring has been stretched beyond its static limit.
    double strained_s = 0.0;
    // Some contact of the same tool part and scene part pushes: the friction spring of this one
    // continues, even if this one does not push.
    bool rubs = false;
    // Tool part and scene part have touched and were not pulled apart since (adhesion).
    bool sticks = false;
    // Slope of a texture's height at the contact, along the surface.
    Vec3 slope{0.0};
    // Push that the contact would have alone, where a texture is rendered.
    double alone_n = 0.0;
    // Force on the tool by texture, adhesion and magnet.
    Vec3 drawn_n{0.0};
};

// Force on a part of the scene in this cycle.
struct PartForce {
    Vec3 force_n{0.0};
    Vec3 moment_nm{0.0}; // about the part's origin
};

struct ProxySettings {
    // Stiffness between device and proxy: N/m, N m/rad, N m/rad of grasp angle; each above 0.
    DofGains stiffness{1000.0, 1000.0, 1000.0, 2.0, 2.0, 2.0, 0.4};
    // Damping divided by stiffness (unit: s): of each contact, along its normal and its surface, of
    // the jaws' stop and of joints. The default is 2 N s/m at 1000 N/m.
    double damping_s = 0.002;
    // Distance within which surfaces are searched; it is enlarged while scene parts move. The proxy
    // follows a hand at 2 m/s: three searches in a cycle of 1 ms let it move by 2.25 mm.
    double margin_m = 0.001;

    friend bool operator==(const ProxySettings &, const ProxySettings &) = default;
};

class ToolProxy {
public:
    void configure(const ProxySettings &settings) noexcept;
    // Places the proxy, which must lie outside all surfaces.
    void put(const ToolPose &pose) noexcept;

    // See JointTie::accept().
    void tie(const Tool &tool, double later_s) noexcept { tie_.accept(tool, later_s, pose_); }
    [[nodiscard]] const JointTie &joints() const noexcept { return tie_; }

    // Computes one cycle of dt_s. device, velocity: pose (filtered and predicted) and velocity of
    // the device. scene: as at the end of the last cycle; its parts are moved on by their
    // velocities.
    void update(const Tool &tool, ContactScene &scene, const ToolPose &device,
                const Twist &velocity, double dt_s, ProxyMemory &memory) noexcept;

    [[nodiscard]] const ToolPose &pose() const noexcept { return pose_; }
    // Wrench on the hand.
    [[nodiscard]] const Wrench &wrench() const noexcept { return wrench_; }
    [[nodiscard]] int contact_count() const noexcept { return count_; }
    [[nodiscard]] const ProxyContact &contact(int i) const noexcept {
        return contacts_[static_cast<std::size_t>(i)];
    }
    [[nodiscard]] const std::array<PartForce, kMaxSceneParts> &given() const noexcept {
        return given_;
    }
    // Grasp torque with which the jaws' stop resists closing (unit: N m): the jaws press on each
    // other or on a held body. 0 when they do not.
    [[nodiscard]] double stop_push_nm() const noexcept { return stop_push_nm_; }
    // Number of closest-point queries in the last cycle.
    [[nodiscard]] int queries() const noexcept { return queries_; }
    // Number of passes (a search and a step) in the last cycle.
    [[nodiscard]] int passes() const noexcept { return passes_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept;

private:
    using Contacts = std::array<ProxyContact, kMaxPoints>;
    using Rows = std::array<ConstraintRow, kMaxRows>;
    // Share of the margin by which the tool may move before the closest points are searched again.
    static constexpr double kPartOfMargin = 0.75;
    // Cosine of 3e-3 rad: normals further apart belong to different surfaces.
    static constexpr double kTurned = 1.0 - 4.5e-6;
    static constexpr double kOpen = -1.0; // depth of a row that never pushes
    // `softness` of solve_rows(). The rows of several points of a face are linearly dependent: with
    // it they share the push. The stiffness falls by this share.
    static constexpr double kRowSoftness = 1e-7;

    // Nothing is in reach: puts the proxy at the device.
    void follow(const ToolPose &device) noexcept;
    // Adds to `sum` what the hand feels of a force on a point of the tool: the part that the joints
    // of a held body (the hinge of a door) do not carry.
    void add_force(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m, const Vec3 &force_n,
                   std::array<double, kDofCount> &sum) const noexcept;
    // Adds the forces of joints to wrench_, except those of their limits, which are rows.
    void add_joints(const Move &pull, const Move &pushed, const Twist &velocity) noexcept;
    [[nodiscard]] double part_at_levers(const Tool &tool, const ContactScene &scene,
                                        double all_n) const noexcept;
    // Returns how a point of the tool moves along `direction`, in units of sqrt(energy): a row of
    // god_object.h.
    [[nodiscard]] Move unit_move(const ToolPart &part, const Jaws &jaws, const Vec3 &point_m,
                                 const Vec3 &direction) const noexcept;
    // Returns the search distance for a part: margin_m, or the reach of its traits if that is
    // larger.
    [[nodiscard]] double look_m(const ScenePart &part, double margin_m) const noexcept {
        return has_traits_ ? std::max(margin_m, reach_m(part.traits)) : margin_m;
    }
    // Returns the search distance of a cycle. The tool may move by kPartOfMargin of it; the rest
    // allows for the approach of moving parts.
    [[nodiscard]] double margin_for(const ContactScene &scene, double dt_s) const noexcept;
    void find_contacts(const Tool &tool, const ContactScene &scene, double margin_m,
                       ProxyMemory &memory) noexcept;
    void offer(const ProxyContact &contact) noexcept;
    [[nodiscard]] Move scaled(const Displacement &by) const noexcept;
    [[nodiscard]] Displacement unscaled(const Move &move) const noexcept;
    // Returns the target shifted by the pushes of the rows.
    [[nodiscard]] Move nearest_to(const Move &target, const Rows &rows,
                                  const RowPushes<kMaxRows> &pushes) const noexcept;
    // Returns an upper bound of how far a move displaces any point of the tool (unit: m).
    [[nodiscard]] double length_of(const Move &move, const Tool &tool) const noexcept;
    // Returns a move toward `step` that is at most most_m long (length_of()). It violates no row,
    // unless the way out of a surface is longer. least: required move along each row.
    [[nodiscard]] Move shortened(const Move &step, const std::array<double, kMaxRows> &least,
                                 const Tool &tool, double most_m) const noexcept;
    // Moves the proxy one step toward the device. Returns true if another search, from the new
    // proxy, may bring it closer. margin_m: as passed to find_contacts(). dt_s: time for which
    // scene parts still move in this cycle.
    bool step_towards(const Tool &tool, const ContactScene &scene, const ToolPose &device,
                      double margin_m, double dt_s, ProxyMemory &memory) noexcept;
    // Solves rows_ after open_seams().
    [[nodiscard]] RowPushes<kMaxRows> solve_over_seams(const Tool &tool, const ContactScene &scene,
                                                       double margin_m, double dt_s,
                                                       ProxyMemory &memory) noexcept;
    // Sets to kOpen the pushing rows of edges that are flush with the surface on which the tool
    // rests. Returns false when there is none.
    bool open_seams(const Tool &tool, const ContactScene &scene, const RowPushes<kMaxRows> &solved,
                    double margin_m, double dt_s, ProxyMemory &memory) noexcept;
    [[nodiscard]] bool is_flush(const ProxyContact &edge, const ProxyContact &floor,
                                const Tool &tool, const ContactScene &scene, double margin_m,
                                double dt_s, ProxyMemory &memory) noexcept;
    void push(const Tool &tool, const ContactScene &scene, const ToolPose &device,
              const Twist &velocity, double dt_s) noexcept;
    void rub(const Tool &tool, const ContactScene &scene, const ToolPose &device,
             const Twist &velocity, double dt_s) noexcept;
    // Returns the nearest contact of the last cycle on the same scene part whose normal is within
    // 45 degrees, or null. touching true: only contacts of the same tool part that pushed count.
    // False: only contacts with `rubs` count, those of the same tool part first.
    [[nodiscard]] const ProxyContact *nearest_before(const ProxyContact &contact,
                                                     bool touching) const noexcept;
    // Returns the mean stretch of the friction springs of the last cycle on the surface of this
    // contact, weighted by push; own_m when there was none.
    [[nodiscard]] double stretch_together_m(const ProxyContact &contact,
                                            double own_m) const noexcept;
    [[nodiscard]] double softness_together(const Rows &rows, int scene_part) const noexcept;
    [[nodiscard]] bool pair_pushes(const ProxyContact &contact) const noexcept;
    // Updates slips_s and strained_s of the contact from `last`, the contact one cycle before (may
    // be null), and returns the friction coefficient of this cycle. stretch_m: of the friction
    // spring. m_per_coefficient: stretch at which a contact with a coefficient of 1 slides.
    // slides_m_s: speed along the surface.
    double friction_now(ProxyContact &contact, const ScenePart &other, const ProxyContact *last,
                        double stretch_m, double m_per_coefficient, double slides_m_s,
                        double dt_s) const noexcept;
    // Return the distances up to which the magnet (magnet_range_m) and any trait (reach_m) act.
    [[nodiscard]] double magnet_range_m(const SurfaceTraits &traits) const noexcept;
    [[nodiscard]] double reach_m(const SurfaceTraits &traits) const noexcept;
    // Sets the contact's slope, and drawn_n to the damping of the texture. Returns the height of
    // the texture at the contact (unit: m): 0 at a crest, negative in a valley. push_n: push
    // without the texture. speed_m_s: of the tool's point relative to the surface.
    double press_into(ProxyContact &contact, const ScenePart &other, double push_n,
                      const Vec3 &speed_m_s, double dt_s) const noexcept;
    [[nodiscard]] bool stuck_before(const ProxyContact &contact) const noexcept;
    [[nodiscard]] double attraction_n(const ProxyContact &contact,
                                      const ScenePart &other) const noexcept;
    void attract(const ContactScene &scene) noexcept;
    void act_by_traits(const Tool &tool, const ContactScene &scene) noexcept;

    ProxySettings settings_;
    Move root_{}; // square root of the stiffness per DOF
    JointTie tie_;
    Move bent_{}; // shift by the joints' springs and motors in the last pass
    ToolPose pose_;
    ToolPose device_; // of the last cycle
    bool placed_ = false;
    Contacts contacts_{};
    int count_ = 0;
    Contacts before_{}; // of the last cycle
    int before_count_ = 0;
    // Rows of the last pass: those of `contacts_`, then the jaws' stop.
    Rows rows_{};
    int row_count_ = 0;
    std::uint32_t active_mask_ = 0;
    std::uint32_t pushing_mask_ = 0;
    Wrench wrench_{};
    std::array<PartForce, kMaxSceneParts> given_{};
    double stop_push_nm_ = 0.0;
    double cycle_s_ = 0.0;
    bool idle_ = true;        // the last cycle left no contact and no force
    bool has_traits_ = false; // some part of this cycle has traits
    int queries_ = 0;
    int passes_ = 0;
};

} // namespace spidar
