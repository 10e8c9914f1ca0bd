#include "godot/hand/scene/surroundings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/scene/box_clearance.h"

namespace spidar {

namespace {

using godot::Object;
using godot::ObjectDB;
using godot::PhysicsServer3D;

constexpr int kMostHits = 16;    // of one query; it is asked again without the bodies that it met
constexpr int kMostQueries = 64; // of one volume in one tick
constexpr double kBoxStep_m = 0.005; // the query's box is made anew when it grows by this
// A body that was met and has no shape near any more is found by queries again after so many ticks.
constexpr std::int64_t kGraceTicks = 30;
constexpr std::int64_t kFactsTicks = 8;
// Physics engines cannot move a body much faster, m/s: a device that goes farther was put elsewhere.
constexpr double kFastest_m_s = 200.0;

bool holds(const std::vector<godot::RID> &list, const godot::RID &rid) {
    return std::find(list.begin(), list.end(), rid) != list.end();
}

Vec3 rounded_up(const Vec3 &half_m) noexcept {
    return kBoxStep_m * glm::ceil(half_m / kBoxStep_m);
}

} // namespace

Surroundings::Surroundings() : rid_key_("rid"), collider_key_("collider_id") {}

Surroundings::~Surroundings() {
    for (Searcher &searcher : searchers_) {
        if (searcher.box.is_valid()) {
            PhysicsServer3D::get_singleton()->free_rid(searcher.box);
        }
    }
}

void Surroundings::clear() {
    bodies_.clear();
    soft_.clear();
    shapes_.clear();
    counts_ = {};
    node_motion_ = {};
}

std::vector<std::string> Surroundings::take_messages() {
    return std::exchange(messages_, {});
}

void Surroundings::update(const SearchSpace &space, const SearchVolume &pads,
                          const SearchVolume *held, std::uint64_t held_object) {
    ++tick_;
    counts_ = {};
    shapes_.clear();
    candidates_.clear();
    shelf_.begin_tick();
    if (space.state == nullptr || !space.now.usable() || !(space.tick_s > 0.0)) {
        return;
    }
    const double moved = glm::length(space.now.origin - space.stepped.origin);
    const bool jumped = !(moved < kFastest_m_s * space.tick_s);
    moment_.now = space.now;
    moment_.in_space = jumped ? space.now : space.stepped;
    node_motion_.note(moment_.in_space, space.tick_s);
    moment_.node = &node_motion_;
    moment_.tick_s = space.tick_s;
    const bool runs = PhysicsServer3D::get_singleton()->space_is_active(space.space);
    moment_.time_scale = runs ? space.time_scale : 0.0;
    volumes_ = {&pads, held};
    if (held_object != held_object_) {
        for (auto &[id, body] : bodies_) {
            body->facts_tick = 0;
        }
        held_object_ = held_object;
    }
    drop_gone(space);
    search(searchers_[0], pads, space);
    if (held != nullptr) {
        search(searchers_[1], *held, space);
    }
    read_exceptions(held_object);
    for (auto &[id, body] : bodies_) {
        if (body->is_node() || body->found_tick == tick_) {
            gather(*body, seen_by(*body));
        }
    }
    list_nearest();
    counts_.soft_bodies = static_cast<int>(soft_.size());
}

void Surroundings::drop_gone(const SearchSpace &space) {
    for (auto place = bodies_.begin(); place != bodies_.end();) {
        const NearBody &body = *place->second;
        const bool gone = body.is_node()
                              ? !body.is_there(space.space) || tick_ - body.near_tick > kGraceTicks
                              : tick_ - body.found_tick > kGraceTicks;
        place = gone ? bodies_.erase(place) : std::next(place);
    }
    const auto freed = [](const auto &soft) {
        return ObjectDB::get_instance(soft.second) == nullptr;
    };
    soft_.erase(std::remove_if(soft_.begin(), soft_.end(), freed), soft_.end());
}

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
        if (body->is_node()) {
            excluded.push_back(body->rid());
        }
    }
    for (const auto &[rid, object] : soft_) {
        excluded.push_back(rid);
    }
    searcher.query->set_transform(
        moment_.in_space.pose_to_world(volume.at.origin_m, volume.at.rotation));
    ask(searcher, space, excluded);
    const WorldFrame &a = moment_.now;
    const WorldFrame &b = moment_.in_space;
    if (a.origin != b.origin || a.rotation != b.rotation) {
        // Bodies that rest in the scene while the node moves on.
        searcher.query->set_transform(a.pose_to_world(volume.at.origin_m, volume.at.rotation));
        ask(searcher, space, excluded);
    }
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

// An engine gives a hit for each shape or triangle, so a list that is full hides bodies: they are met in the next query, which
// leaves out those of the last.
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
            if (!holds(excluded, rid)) {
                meet(rid, static_cast<std::uint64_t>(hit[collider_key_]), excluded);
            }
        }
        if (count < kMostHits) {
            return;
        }
    }
}

void Surroundings::meet(const godot::RID &rid, std::uint64_t object,
                        std::vector<godot::RID> &excluded) {
    excluded.push_back(rid);
    if (const auto known = bodies_.find(rid.get_id()); known != bodies_.end()) {
        known->second->found_tick = tick_;
        return;
    }
    const Object *collider = ObjectDB::get_instance(object);
    if (collider != nullptr && collider->is_class("SoftBody3D")) {
        soft_.emplace_back(rid, object);
        tell("A soft body is in reach of the hand. It is not felt.");
        return;
    }
    auto body = std::make_unique<NearBody>(rid, object);
    body->found_tick = tick_;
    body->near_tick = tick_;
    bodies_.emplace(rid.get_id(), std::move(body));
}

// The server does not tell the exceptions of a body without a node.
void Surroundings::read_exceptions(std::uint64_t held_object) {
    spared_by_held_.clear();
    auto *held = Object::cast_to<godot::PhysicsBody3D>(ObjectDB::get_instance(held_object));
    if (held == nullptr) {
        return;
    }
    const godot::Array others = held->get_collision_exceptions();
    for (std::int64_t i = 0; i < others.size(); ++i) {
        const auto *other = Object::cast_to<godot::PhysicsBody3D>(static_cast<Object *>(others[i]));
        if (other != nullptr) {
            spared_by_held_.push_back(other->get_rid());
        }
    }
}

std::uint8_t Surroundings::seen_by(const NearBody &body) const {
    const std::uint32_t layer =
        PhysicsServer3D::get_singleton()->body_get_collision_layer(body.rid());
    unsigned seen = 0;
    for (unsigned i = 0; i < volumes_.size(); ++i) {
        const SearchVolume *volume = volumes_[i];
        if (volume != nullptr && (volume->mask & layer) != 0 &&
            !holds(volume->excluded, body.rid())) {
            seen |= 1U << i;
        }
    }
    if ((seen & kSeenByHeld) != 0 && (body.spares_held || holds(spared_by_held_, body.rid()))) {
        seen &= ~static_cast<unsigned>(kSeenByHeld);
    }
    return static_cast<std::uint8_t>(seen);
}

void Surroundings::gather(NearBody &body, std::uint8_t seen) {
    if (seen == 0) {
        return;
    }
    ++counts_.bodies;
    if (tick_ >= body.facts_tick) {
        body.read_facts(names_);
        // Not all bodies in the same tick.
        body.facts_tick = tick_ + kFactsTicks / 2 + body.rid().get_id() % kFactsTicks;
        body.spares_held = body.spares(held_object_);
    }
    body.read_place(moment_);
    body.read_shapes(shelf_, next_id_);
    for (std::size_t i = 0; i < body.shapes().size(); ++i) {
        add_candidate(body, i, seen);
    }
}

void Surroundings::add_candidate(NearBody &body, std::size_t index, std::uint8_t seen) {
    BodyShape &shape = body.shapes()[index];
    shape.near = false;
    if (shape.disabled) {
        return;
    }
    const TurnAndScale apart = take_apart(body.basis() * to_core(shape.local.basis));
    if (apart.sheared) {
        if (std::find(told_sheared_.begin(), told_sheared_.end(), shape.id) ==
            told_sheared_.end()) {
            told_sheared_.push_back(shape.id);
            tell(body.name() + ": shape " + std::to_string(index) +
                 " is not felt: it is sheared, or it has no size along an axis.");
        }
        ++counts_.refused;
        return;
    }
    const WorldFrame &frame = body.frame();
    Candidate candidate;
    candidate.body = &body;
    candidate.index = index;
    candidate.scale = apart.scale / frame.scale;
    candidate.at.origin_m =
        frame.point_to_device(body.origin() + body.basis() * to_core(shape.local.origin));
    candidate.at.rotation = glm::transpose(frame.rotation) * apart.turn;

    const ShapeData &data = shape.source->data;
    const bool wall = data.numbers.type == PhysicsServer3D::SHAPE_WORLD_BOUNDARY;
    const Vec3 a = candidate.scale * data.lower;
    const Vec3 b = candidate.scale * data.upper;
    TurnedBox box;
    Vec3 normal(0.0);
    double offset_m = 0.0;
    if (wall) {
        const Vec3 inside = data.numbers.normal / candidate.scale;
        normal = candidate.at.rotation * glm::normalize(inside);
        offset_m =
            data.numbers.offset / glm::length(inside) + glm::dot(normal, candidate.at.origin_m);
    } else {
        box.at.rotation = candidate.at.rotation;
        box.at.origin_m = candidate.at.origin_m + candidate.at.rotation * (0.5 * (a + b));
        box.half_extents_m = 0.5 * glm::abs(b - a);
    }
    bool first = true;
    for (unsigned i = 0; i < volumes_.size(); ++i) {
        if ((seen & (1U << i)) == 0) {
            continue;
        }
        const SearchVolume &volume = *volumes_[i];
        const TurnedBox mine{volume.at, volume.half_extents_m};
        const double gap = wall ? clearance(mine, normal, offset_m) : clearance(mine, box);
        if (gap <= volume.margin_m) {
            candidate.seen_by = static_cast<std::uint8_t>(candidate.seen_by | (1U << i));
            candidate.clearance_m = first ? gap : std::min(candidate.clearance_m, gap);
            first = false;
        }
    }
    if (candidate.seen_by == 0) {
        ++counts_.far;
        return;
    }
    shape.near = true;
    body.near_tick = tick_;
    candidates_.push_back(candidate);
}

void Surroundings::list_nearest() {
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate &a, const Candidate &b) {
        return a.clearance_m != b.clearance_m
                   ? a.clearance_m < b.clearance_m
                   : a.body->shapes()[a.index].id < b.body->shapes()[b.index].id;
    });
    for (const Candidate &candidate : candidates_) {
        if (shapes_.size() == kMostNearShapes) {
            ++counts_.left_out;
            continue;
        }
        NearBody &body = *candidate.body;
        const BodyShape &shape = body.shapes()[candidate.index];
        Piece &piece = shelf_.cooked(*shape.source, candidate.scale);
        if (piece.state == PieceState::refused && !std::exchange(piece.told, true)) {
            tell(body.name() + ": shape " + std::to_string(candidate.index) +
                 " is not felt: " + piece.why_not);
        }
        if (piece.shape == nullptr) {
            ++(piece.state == PieceState::refused ? counts_.refused : counts_.cooking);
            continue;
        }
        NearShape near;
        near.body = body.rid();
        near.collider = body.object();
        near.shape_index = static_cast<int>(candidate.index);
        near.id = shape.id;
        near.shape = piece.shape;
        near.at = candidate.at;
        near.velocity_m_s = body.velocity_at(candidate.at.origin_m);
        near.angular_rad_s = body.angular_rad_s();
        near.body_center_m = body.center_m();
        near.mode = body.mode();
        near.mass_kg = body.mass_kg();
        near.seen_by = candidate.seen_by;
        near.clearance_m = candidate.clearance_m;
        near.facts = body.facts();
        shapes_.push_back(std::move(near));
    }
    counts_.shapes = static_cast<int>(shapes_.size());
}

} // namespace spidar
