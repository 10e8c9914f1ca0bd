// Finds the shapes of the scene near the hand: reads them from the physics server once per physics
// tick, cooks them and places them in the device frame. Main thread only; call update() in a
// physics tick.
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

// A box around the pads, or around the held body, near which shapes are searched. Device frame.
struct SearchVolume {
    Placement at; // the origin is the box's center
    // Of the object on its way from the device's pose to the proxy's.
    Vec3 half_extents_m{0.0};
    // Shapes within this distance of the box are listed. Must cover the motion of a tick.
    double margin_m = 0.0;
    std::uint32_t mask = 1;           // collision layers that the object touches
    std::vector<godot::RID> excluded; // bodies that are not listed
};

struct SearchSpace {
    godot::PhysicsDirectSpaceState3D *state = nullptr;
    godot::RID space;
    WorldFrame now; // of the device's node in this tick
    // Of the device's node at the last physics step, to which the poses of moving bodies belong.
    WorldFrame stepped;
    double tick_s = 1.0 / 60.0; // length of a physics tick
    double time_scale = 1.0;    // Engine.time_scale
};

// A device's node that moves faster than this in the scene counts as teleported: physics engines
// cannot move a body much faster.
inline constexpr double kFastestBody_m_s = 200.0;

enum SeenBy : std::uint8_t { kSeenByPads = 1, kSeenByHeld = 2 };

struct NearShape {
    godot::RID body;
    std::uint64_t collider = 0; // instance id; 0: a body without an object
    int shape_index = 0;
    // Identifies this shape of this body while the body stays near. Another shape gets the same id
    // only after 2^31 - 1 newer ids.
    std::int32_t id = 0;
    std::shared_ptr<const CookedShape> shape;
    Placement at;            // device frame
    Vec3 velocity_m_s{0.0};  // of at.origin_m, per second of device time
    Vec3 angular_rad_s{0.0}; // device frame
    // See ScenePart::belt_m_s.
    Vec3 belt_m_s{0.0};
    Vec3 belt_rad_s{0.0};
    double mass_kg = 0.0;     // 0 unless physics moves the body
    std::uint8_t seen_by = 0; // bits of SeenBy: which volumes the shape is near
    BodyFacts facts;
    SurfaceTraits traits; // device meters, axes of the shape
};

struct SurroundingsCounts {
    int queries = 0;     // of the physics server
    int bodies = 0;      // bodies that were found near and read
    int shapes = 0;      // listed
    int far = 0;         // shapes of those bodies that are not near
    int left_out = 0;    // near, but kMostNearShapes are nearer
    int cooking = 0;     // near, but not cooked yet
    int refused = 0;     // near, but not renderable: take_messages() returned why
    int soft_bodies = 0; // soft bodies found so far, which are not rendered
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

    // Updates shapes(), nearest first. held: null while nothing is held, or while the held body is
    // detained. held_object: instance id of the held body, or 0.
    void update(const SearchSpace &space, const SearchVolume &pads,
                const SearchVolume *held = nullptr, std::uint64_t held_object = 0);
    // Reads the project's default material. Called when the hand enters the scene tree.
    void open() { facts_.open(); }
    // Forgets all bodies. Called when the hand leaves the scene tree.
    void clear();

    [[nodiscard]] const std::vector<NearShape> &shapes() const noexcept { return shapes_; }
    [[nodiscard]] const SurroundingsCounts &counts() const noexcept { return counts_; }
    [[nodiscard]] const ShapeShelf::Counts &shelf() const noexcept { return shelf_.counts(); }
    // Returns messages about things that cannot be rendered, each once, and empties the list.
    [[nodiscard]] std::vector<std::string> take_messages();

private:
    // The query for one of the two volumes.
    struct Searcher {
        godot::Ref<godot::PhysicsShapeQueryParameters3D> query;
        godot::RID box;
        Vec3 box_half{0.0};
        std::vector<godot::RID> excluded; // the query's present list
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
    std::vector<std::pair<godot::RID, std::uint64_t>> soft_; // soft bodies with instance ids
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
