// The shapes of the scene near the hand: read from the physics server once per physics tick,
// cooked, and placed in the device frame. Main thread only; call update() in a physics tick.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <godot_cpp/classes/physics_direct_space_state3d.hpp>
#include <godot_cpp/classes/physics_shape_query_parameters3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/rid.hpp>

#include "device/contact/shapes/placement.h"
#include "godot/base/node_motion.h"
#include "godot/base/world_frame.h"
#include "godot/hand/scene/near_body.h"
#include "godot/hand/scene/shape_shelf.h"

namespace spidar {

inline constexpr std::size_t kMostNearShapes = 32;

// A box around an object that touches the scene. Device frame (unit: m).
struct SearchVolume {
    Placement at;
    Vec3 half_extents_m{0.0}; // of the object itself
    // Shapes within this distance are listed. At least the largest motion in a tick.
    double margin_m = 0.0;
    std::uint32_t mask = 1; // collision layers that the object meets
    std::vector<godot::RID> excluded;
};

struct SearchSpace {
    godot::PhysicsDirectSpaceState3D *state = nullptr;
    godot::RID space;
    WorldFrame now; // of the device's node
    // The device's node at the last physics step, at which the bodies of physics have their poses.
    WorldFrame stepped;
    // Device time between two ticks. The game's time may run slower.
    double tick_s = 1.0 / 60.0;
    double time_scale = 1.0; // Engine.time_scale
};

// Speed above which the device was teleported: physics engines cannot move a body much faster.
inline constexpr double kFastestBody_m_s = 200.0;

enum SeenBy : std::uint8_t { kSeenByPads = 1, kSeenByHeld = 2 };

struct NearShape {
    godot::RID body;
    std::uint64_t collider = 0; // instance id; 0: a body without an object
    int shape_index = 0;
    // Belongs to this shape of this body while it stays near; ids are never reused.
    std::int32_t id = 0;
    std::shared_ptr<const CookedShape> shape;
    Placement at;            // device frame
    Vec3 velocity_m_s{0.0};  // of at.origin_m, per second of device time
    Vec3 angular_rad_s{0.0}; // device frame
    // See ScenePart::belt_m_s.
    Vec3 belt_m_s{0.0};
    Vec3 belt_rad_s{0.0};
    double mass_kg = 0.0;     // 0 unless physics moves the body
    std::uint8_t seen_by = 0; // SeenBy
    BodyFacts facts;
    SurfaceTraits traits; // device meters, axes of the shape
};

struct SurroundingsCounts {
    int queries = 0;
    int bodies = 0;      // near enough to be read
    int shapes = 0;      // listed
    int far = 0;         // shapes of those bodies that are not near
    int left_out = 0;    // near, beyond the nearest kMostNearShapes
    int cooking = 0;     // near, but not ready yet
    int refused = 0;     // near, never rendered: take_messages() returns why
    int soft_bodies = 0; // found so far; not rendered
};

// Returns whether `rid` is in the list.
[[nodiscard]] inline bool holds_rid(const std::vector<godot::RID> &list, const godot::RID &rid) {
    return std::find(list.begin(), list.end(), rid) != list.end();
}

class Surroundings {
public:
    Surroundings();
    ~Surroundings();
    Surroundings(const Surroundings &) = delete;
    Surroundings &operator=(const Surroundings &) = delete;

    // Updates shapes(), nearest first. held: null while nothing is held. held_object: instance id
    // of the held body.
    void update(const SearchSpace &space, const SearchVolume &pads,
                const SearchVolume *held = nullptr, std::uint64_t held_object = 0);
    // Reads the project's defaults. Called when the node enters its scene.
    void open() { facts_.open(); }
    // Forgets all bodies. Called when the node leaves its scene.
    void clear();

    [[nodiscard]] const std::vector<NearShape> &shapes() const noexcept { return shapes_; }
    [[nodiscard]] const SurroundingsCounts &counts() const noexcept { return counts_; }
    [[nodiscard]] const ShapeShelf::Counts &shelf() const noexcept { return shelf_.counts(); }
    // Returns messages about things that cannot be rendered, each once, and empties the list.
    [[nodiscard]] std::vector<std::string> take_messages();

private:
    // Query state of one of the two volumes.
    struct Searcher {
        godot::Ref<godot::PhysicsShapeQueryParameters3D> query;
        godot::RID box;
        Vec3 box_half{0.0};
        std::vector<godot::RID> excluded; // as the query has it
        std::uint32_t mask = 0;
    };
    struct Possible {
        NearBody *body = nullptr;
        std::size_t index = 0;
        double bound_m = 0.0;
        std::uint8_t seen = 0;
    };
    struct Candidate {
        NearBody *body = nullptr;
        std::size_t index = 0;
        Placement at;
        Vec3 scale{1.0};
        double clearance_m = 0.0;
        std::uint8_t seen_by = 0;
    };

    void search(Searcher &searcher, const SearchVolume &volume, const SearchSpace &space);
    void ask(Searcher &searcher, const SearchSpace &space, std::vector<godot::RID> &excluded);
    void exclude(Searcher &searcher, const std::vector<godot::RID> &excluded);
    void meet(const godot::RID &rid, std::uint64_t object, const godot::RID &space);
    void drop_gone(const SearchSpace &space);
    void read_exceptions(std::uint64_t held_object);
    [[nodiscard]] std::uint8_t seen_by(const NearBody &body) const;
    void gather(NearBody &body, std::uint8_t seen);
    [[nodiscard]] double least_clearance(const Vec3 &middle_m, double radius_m,
                                         std::uint8_t seen) const;
    void keep_most_possible();
    void add_candidate(NearBody &body, std::size_t index, std::uint8_t seen);
    void list_nearest();
    [[nodiscard]] static SurfaceTraits in_shape(const NearBody &body, const Placement &at);
    void tell(const std::string &message) { messages_.push_back(message); }

    ShapeShelf shelf_;
    BodyFactsReader facts_;
    godot::Variant rid_key_;
    godot::Variant collider_key_;
    std::array<Searcher, 2> searchers_; // pads, held
    std::array<const SearchVolume *, 2> volumes_{};
    std::unordered_map<std::int64_t, std::unique_ptr<NearBody>> bodies_;
    std::vector<std::pair<godot::RID, std::uint64_t>> soft_; // with their instance ids
    std::vector<godot::RID> spared_by_held_; // collision exceptions of the held body
    std::uint64_t held_object_ = 0;
    NodeMotion node_motion_;
    Moment moment_;
    std::int64_t tick_ = 0;
    std::int32_t next_id_ = 1;
    std::vector<Possible> possible_;
    std::vector<Candidate> candidates_;
    std::vector<NearShape> shapes_;
    SurroundingsCounts counts_;
    std::vector<std::string> messages_;
    std::vector<std::int32_t> told_sheared_; // ids of shapes
};

} // namespace spidar
