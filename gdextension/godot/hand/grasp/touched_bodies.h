// Maps the points of the device's report to bodies. The report refers to the scene that was
// rendered last, which may be older than the present one.
#pragma once

#include <cstdint>
#include <unordered_map>

#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/rid.hpp>

#include "godot/hand/scene/surroundings.h"

namespace spidar {

struct TouchedBody {
    godot::RID rid;
    std::uint64_t collider = 0; // instance id; 0: a body without an object
    bool is_pushed = false;     // physics moves the body
    BodyFacts facts;
    Placement at; // of the shape when last published; device frame
    std::int64_t tick = 0;

    // Whether the node of the body was freed; the server does not know its RID then.
    [[nodiscard]] bool is_gone() const {
        return collider != 0 && godot::ObjectDB::get_instance(collider) == nullptr;
    }
    [[nodiscard]] std::uint64_t key() const noexcept {
        return static_cast<std::uint64_t>(rid.get_id());
    }
};

class TouchedBodies {
public:
    // Called once per tick, after the scene was gathered.
    void note(const std::vector<NearShape> &shapes) {
        ++tick_;
        for (const NearShape &shape : shapes) {
            bodies_[shape.id] = {shape.body,  shape.collider, shape.mass_kg > 0.0,
                                 shape.facts, shape.at,       tick_};
        }
        std::erase_if(bodies_,
                      [this](const auto &one) { return tick_ - one.second.tick > kKeptTicks; });
    }
    // Finds a body by the id of a scene part; null when unknown.
    [[nodiscard]] const TouchedBody *find(std::int32_t id) const {
        const auto found = bodies_.find(id);
        return found != bodies_.end() ? &found->second : nullptr;
    }
    void clear() noexcept { bodies_.clear(); }

private:
    // Ticks for which a body is remembered after it was last near.
    static constexpr std::int64_t kKeptTicks = 30;

    std::unordered_map<std::int32_t, TouchedBody> bodies_;
    std::int64_t tick_ = 0;
};

} // namespace spidar
