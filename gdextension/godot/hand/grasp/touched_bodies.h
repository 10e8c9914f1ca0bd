// Finds the body for the id of a shape in the servo loop's report. The report refers to the scene
// that was rendered last, which may be older than the present one.
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
    Placement at; // pose of the shape when it was last near; device frame
    std::int64_t tick = 0;

    // Returns whether the node of the body was freed, so that the server does not know the RID.
    [[nodiscard]] bool is_gone() const {
        return collider != 0 && godot::ObjectDB::get_instance(collider) == nullptr;
    }
    [[nodiscard]] std::uint64_t key() const noexcept {
        return static_cast<std::uint64_t>(rid.get_id());
    }
};

class TouchedBodies {
public:
    // Called once per tick with Surroundings::shapes().
    void note(const std::vector<NearShape> &shapes) {
        ++tick_;
        for (const NearShape &shape : shapes) {
            bodies_[shape.id] = {shape.body,  shape.collider, shape.mass_kg > 0.0,
                                 shape.facts, shape.at,       tick_};
        }
        std::erase_if(bodies_,
                      [this](const auto &one) { return tick_ - one.second.tick > kKeptTicks; });
    }
    // Finds a body by NearShape::id; returns null when the id is unknown.
    [[nodiscard]] const TouchedBody *find(std::int32_t id) const {
        const auto found = bodies_.find(id);
        return found != bodies_.end() ? &found->second : nullptr;
    }
    void clear() noexcept { bodies_.clear(); }

private:
    // Number of ticks for which a shape is remembered after it was last near.
    static constexpr std::int64_t kKeptTicks = 30;

    std::unordered_map<std::int32_t, TouchedBody> bodies_;
    std::int64_t tick_ = 0;
};

} // namespace spidar
