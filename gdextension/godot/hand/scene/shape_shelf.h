// The cooked shapes of a scene, by the shape of the physics server and its scale. A shape is cooked once, kept while it is
// used, and cooked anew when its data change. Small shapes are cooked at once; large ones by the engine's threads, and until
// one is ready there is no cooked shape of it. Main thread only.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <godot_cpp/variant/rid.hpp>

#include "device/contact/shapes/cooked_shape.h"
#include "godot/hand/scene/shape_data.h"

namespace spidar {

enum class PieceState : std::uint8_t {
    cooking, // not felt yet
    ready,
    refused, // never felt: why_not tells
};

// One shape at one scale.
struct Piece {
    Vec3 scale{1.0}; // device metres for a unit of the shape; x below zero: mirrored
    PieceState state = PieceState::cooking;
    std::shared_ptr<const CookedShape>
        shape; // while it is cooked anew: as it was; or of about this scale
    std::string why_not;
    bool told = false;         // for who tells it: once is enough
    std::uint64_t version = 0; // of the data that it was cooked from
    std::uint64_t asked = 0;   // newest version that was given to be cooked
    std::int64_t used_tick = 0;
};

class ShapeShelf {
public:
    struct Source {
        godot::RID shape;
        ShapeData data;
        std::uint64_t version = 1; // of the data
        std::uint64_t bounds = 1;  // of data.bounds
        std::vector<std::unique_ptr<Piece>> pieces;
        int jobs = 0;
        std::int64_t used_tick = 0;
        std::int64_t next_look = 0;
    };
    struct Counts {
        int held = 0;    // cooked shapes on the shelf
        int cooking = 0; // now
        int cooked = 0;  // since the start
        int refused = 0; // since the start
    };

    ShapeShelf() = default;
    ~ShapeShelf();
    ShapeShelf(const ShapeShelf &) = delete;
    ShapeShelf &operator=(const ShapeShelf &) = delete;

    // Once a tick, first: takes what the threads have cooked, and lets go of what nobody uses.
    void begin_tick();
    // Of a shape that the server has. Stays on the shelf while the caller keeps it.
    [[nodiscard]] std::shared_ptr<Source> find(const godot::RID &shape);
    // Once a tick for each shape that is near: sees whether its data changed. Where the engine copies its data for each look
    // (concave shapes of GodotPhysics), large shapes are looked at less often.
    void look_again(Source &source);
    // Valid until the next tick.
    [[nodiscard]] Piece &cooked(Source &source, const Vec3 &scale);
    [[nodiscard]] std::int64_t tick() const noexcept { return tick_; }
    [[nodiscard]] const Counts &counts() const noexcept { return counts_; }

private:
    struct Job {
        ShapeData data; // keeps the points
        Vec3 scale{1.0};
        std::uint64_t version = 0;
        std::weak_ptr<Source> source;
        std::int64_t task = 0;
        CookResult result;
        ShapeBounds bounds;
        std::atomic<bool> done{false};
        std::atomic<bool> unwanted{false};
    };
    static void run(void *job);
    static void stand_in(const Source &source, Piece &piece);
    void start(Source &source, Piece &piece);
    void put(Piece &piece, std::uint64_t version, CookResult result);
    void take_finished();
    void let_go();

    ShapeReader reader_;
    std::unordered_map<std::int64_t, std::shared_ptr<Source>> sources_;
    std::vector<std::unique_ptr<Job>> jobs_;
    std::int64_t tick_ = 0;
    Counts counts_;
};

} // namespace spidar
