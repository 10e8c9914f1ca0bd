#include "godot/hand/scene/surroundings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/variant/string.hpp>

#include "godot/base/type_conversions.h"
#include "godot/hand/scene/box_clearance.h"

namespace spidar {

namespace {

using godot::Object;
using godot::ObjectDB;
using godot::PhysicsServer3D;

// Ticks after which a body without near shapes must be found by a query again.
constexpr std::int64_t kGraceTicks = 30;
constexpr std::int64_t kFactsTicks = 8;
constexpr std::size_t kMostExamined = 3 * kMostNearShapes;
constexpr double kNever_m = 1e9;

// Returns the clearance (unit: m) between a shape at that scale and pose and the volume's object. 0
// while the shape's bounds are unknown.
double clearance_of(const ShapeData &data, const Vec3 &scale, const Placement &at,
                    const SearchVolume &volume) {
    const TurnedBox mine{volume.at, volume.half_extents_m};
    if (data.numbers.type == PhysicsServer3D::SHAPE_WORLD_BOUNDARY) {
        const Vec3 inside = data.numbers.normal / scale;
        const Vec3 normal = at.rotation * glm::normalize(inside);
        return clearance(mine, normal,
                         data.numbers.offset / glm::length(inside) + glm::dot(normal, at.origin_m));
    }
    if (!data.bounds.known()) {
        return 0.0;
    }
    const Vec3 a = scale * data.bounds.lower;
    const Vec3 b = scale * data.bounds.upper;
    const Placement middle{at.origin_m + at.rotation * (0.5 * (a + b)), at.rotation};
    return clearance(mine, TurnedBox{middle, 0.5 * glm::abs(b - a)});
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
    const bool jumped = !(moved < kFastestBody_m_s * space.tick_s);
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
    possible_.clear();
    for (auto &[id, body] : bodies_) {
        gather(*body, seen_by(*body));
    }
    keep_most_possible();
    for (const Possible &one : possible_) {
        add_candidate(*one.body, one.index, one.seen);
    }
    list_nearest();
    counts_.soft_bodies = static_cast<int>(soft_.size());
}

void Surroundings::drop_gone(const SearchSpace &space) {
    for (auto place = bodies_.begin(); place != bodies_.end();) {
        NearBody &body = *place->second;
        const bool gone = tick_ - body.near_tick > kGraceTicks || !body.is_there(space.space);
        place = gone ? bodies_.erase(place) : std::next(place);
    }
    const auto freed = [](const auto &soft) {
        return soft.second != 0 && ObjectDB::get_instance(soft.second) == nullptr;
    };
    soft_.erase(std::remove_if(soft_.begin(), soft_.end(), freed), soft_.end());
}

// The server does not report the collision exceptions of a body without a node.
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
            !holds_rid(volume->excluded, body.rid())) {
            seen |= 1U << i;
        }
    }
    if ((seen & kSeenByHeld) != 0 && (body.spares_held || holds_rid(spared_by_held_, body.rid()))) {
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
        body.read_facts(facts_);
        for (const std::string &message : facts_.take_messages()) {
            tell(message);
        }
        // Spreads the reading over several ticks.
        body.facts_tick = tick_ + kFactsTicks / 2 + body.rid().get_id() % kFactsTicks;
        body.spares_held = body.spares(held_object_);
    }
    body.read_place(moment_);
    body.read_shapes(shelf_, next_id_);
    const WorldFrame &frame = body.frame();
    const Mat3 axes = glm::transpose(frame.rotation) * body.basis() / frame.scale;
    const Vec3 origin_m = frame.point_to_device(body.origin());
    const double stretch = std::sqrt(std::max(
        {glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]), glm::dot(axes[2], axes[2])}));
    for (std::size_t i = 0; i < body.shapes().size(); ++i) {
        BodyShape &shape = body.shapes()[i];
        shape.listed = false;
        if (shape.disabled) {
            continue;
        }
        const double bound_m =
            least_clearance(origin_m + axes * shape.middle, stretch * shape.radius, seen);
        if (!(bound_m <= 0.0)) { // true for NaN
            ++counts_.far;
        } else {
            possible_.push_back({&body, i, bound_m, seen});
        }
    }
}

// Returns a quick lower bound (unit: m) of a ball's distance from the volumes that see it, beyond
// their margins.
double Surroundings::least_clearance(const Vec3 &middle_m, double radius_m,
                                     std::uint8_t seen) const {
    double least = kNever_m;
    for (unsigned i = 0; i < volumes_.size(); ++i) {
        if ((seen & (1U << i)) != 0) {
            const SearchVolume &volume = *volumes_[i];
            const Vec3 apart =
                glm::abs(glm::transpose(volume.at.rotation) * (middle_m - volume.at.origin_m)) -
                volume.half_extents_m;
            const double outside = glm::length(glm::max(apart, Vec3(0.0)));
            const double inside = std::min(std::max({apart.x, apart.y, apart.z}), 0.0);
            least = std::min(least, outside + inside - radius_m - volume.margin_m);
        }
    }
    return least;
}

// Keeps the nearest by their balls when hundreds are possible.
void Surroundings::keep_most_possible() {
    if (possible_.size() > kMostExamined) {
        const auto end = possible_.begin() + static_cast<std::ptrdiff_t>(kMostExamined);
        std::nth_element(
            possible_.begin(), end, possible_.end(),
            [](const Possible &a, const Possible &b) { return a.bound_m < b.bound_m; });
        counts_.left_out += static_cast<int>(possible_.size() - kMostExamined);
        possible_.resize(kMostExamined);
    }
}

void Surroundings::add_candidate(NearBody &body, std::size_t index, std::uint8_t seen) {
    BodyShape &shape = body.shapes()[index];
    const TurnAndScale apart = take_apart(body.basis() * to_core(shape.local.basis));
    if (apart.sheared) {
        if (std::find(told_sheared_.begin(), told_sheared_.end(), shape.id) ==
            told_sheared_.end()) {
            told_sheared_.push_back(shape.id);
            tell(body.name() + ": shape " + std::to_string(index) +
                 " is not felt: it is sheared or has no size along an axis; change its scale.");
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

    bool first = true;
    for (unsigned i = 0; i < volumes_.size(); ++i) {
        if ((seen & (1U << i)) == 0) {
            continue;
        }
        const SearchVolume &volume = *volumes_[i];
        const double gap = clearance_of(shape.source->data, candidate.scale, candidate.at, volume);
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
    body.near_tick = tick_;
    candidates_.push_back(candidate);
}

// Returns the body's traits in the frame of a shape at `at`.
SurfaceTraits Surroundings::in_shape(const NearBody &body, const Placement &at) {
    SurfaceTraits traits = body.facts().traits;
    const WorldFrame &frame = body.frame();
    traits.magnet_range_m /= frame.scale;
    traits.texture.wavelength_m /= frame.scale;
    traits.texture.depth_m /= frame.scale;
    if (traits.texture.across != Vec3(0.0)) {
        const Vec3 in_scene = take_apart(body.basis()).turn * traits.texture.across;
        traits.texture.across = glm::transpose(at.rotation) * frame.turn_to_device(in_scene);
    }
    return traits;
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
        BodyShape &shape = body.shapes()[candidate.index];
        shape.listed = true;
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
        near.belt_m_s = body.belt_velocity_at(candidate.at.origin_m);
        near.belt_rad_s = body.belt_rad_s();
        near.mass_kg = body.mass_kg();
        near.seen_by = candidate.seen_by;
        near.facts = body.facts();
        near.traits = in_shape(body, near.at);
        shapes_.push_back(std::move(near));
    }
    counts_.shapes = static_cast<int>(shapes_.size());
}

} // namespace spidar
