// Search for bodies by Surroundings.
#include <algorithm>
#include <utility>

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/scene/surroundings.h"

namespace spidar {

namespace {

using godot::Object;
using godot::ObjectDB;
using godot::PhysicsServer3D;

constexpr int kMostHits =
    4; // of one query: each costs the engine a microsecond, and a body of many shapes gives many
constexpr int kMostQueries = 64;     // of one volume in one tick
constexpr double kBoxStep_m = 0.005; // the query's box is made anew when it grows by this

Vec3 rounded_up(const Vec3 &half_m) noexcept {
    return kBoxStep_m * glm::ceil(half_m / kBoxStep_m);
}

} // namespace

void Surroundings::search(Searcher &searcher, const SearchVolume &volume,
                          const SearchSpace &space) {
    auto *server = PhysicsServer3D::get_singleton();
    if (searcher.query.is_null()) {
        searcher.query.instantiate();
        searcher.box = server->box_shape_create();
        searcher.query->set_shape_rid(searcher.box);
    }
    const Vec3 half = rounded_up(volume.half_extents_m + Vec3(volume.margin_m)) * space.now.scale;
    if (half != searcher.box_half) {
        server->shape_set_data(searcher.box, to_godot(half));
        searcher.box_half = half;
    }
    if (searcher.mask != volume.mask) {
        searcher.query->set_collision_mask(volume.mask);
        searcher.mask = volume.mask;
    }
    std::vector<godot::RID> excluded = volume.excluded;
    for (const auto &[id, body] : bodies_) {
        excluded.push_back(body->rid());
    }
    for (const auto &[rid, object] : soft_) {
        excluded.push_back(rid);
    }
    const auto look = [&](const WorldFrame &frame, const Vec3 &middle_m, double part) {
        searcher.query->set_transform(frame.pose_to_world(
            volume.at.origin_m + volume.at.rotation * middle_m, part * volume.at.rotation));
        ask(searcher, space, excluded);
    };
    look(moment_.in_space, Vec3(0.0), 1.0);
    const WorldFrame &now = moment_.now;
    if (now.origin != moment_.in_space.origin || now.rotation != moment_.in_space.rotation) {
        look(now, Vec3(0.0), 1.0); // bodies that rest in the scene while the node moves on
    }
    // Jolt ignores triangles seen from behind, and looks from the center of the query's shape: it
    // misses a mesh that closes around this center, such as one between the jaws. An eighth of the
    // box is therefore queried too, another one in each tick.
    const auto part = static_cast<unsigned>(tick_) % 8U;
    const Vec3 side((part & 1U) != 0 ? 0.5 : -0.5, (part & 2U) != 0 ? 0.5 : -0.5,
                    (part & 4U) != 0 ? 0.5 : -0.5);
    look(moment_.in_space, side * (searcher.box_half / space.now.scale), 0.5);
}

void Surroundings::exclude(Searcher &searcher, const std::vector<godot::RID> &excluded) {
    if (excluded == searcher.excluded) {
        return;
    }
    godot::TypedArray<godot::RID> list;
    for (const godot::RID &rid : excluded) {
        list.push_back(rid);
    }
    searcher.query->set_exclude(list);
    searcher.excluded = excluded;
}

// An engine reports a hit per shape or triangle, so that a full list hides bodies. The next query
// finds them, since it excludes those of the last.
void Surroundings::ask(Searcher &searcher, const SearchSpace &space,
                       std::vector<godot::RID> &excluded) {
    for (int i = 0; i < kMostQueries; ++i) {
        exclude(searcher, excluded);
        const godot::Array hits = space.state->intersect_shape(searcher.query, kMostHits);
        ++counts_.queries;
        const std::int64_t count = hits.size();
        for (std::int64_t k = 0; k < count; ++k) {
            const godot::Dictionary hit(hits[k]);
            const godot::RID rid(hit[rid_key_]);
            if (!holds_rid(excluded, rid)) {
                excluded.push_back(rid);
                meet(rid, static_cast<std::uint64_t>(hit[collider_key_]), space.space);
            }
        }
        if (count < kMostHits) {
            return;
        }
    }
}

void Surroundings::meet(const godot::RID &rid, std::uint64_t object, const godot::RID &space) {
    auto body = std::make_unique<NearBody>(rid, object);
    if (body->is_there(space)) {
        body->near_tick = tick_;
        bodies_.emplace(rid.get_id(), std::move(body));
        return;
    }
    const auto known = std::find_if(soft_.begin(), soft_.end(),
                                    [&rid](const auto &soft) { return soft.first == rid; });
    if (known == soft_.end()) {
        soft_.emplace_back(rid, object);
        const auto *node = Object::cast_to<godot::Node>(ObjectDB::get_instance(object));
        const godot::String name = node != nullptr ? godot::String(node->get_name()) : "A body";
        tell(std::string(name.utf8().get_data()) +
             " is not felt, because it is a soft body: use a rigid body.");
    }
}

} // namespace spidar
