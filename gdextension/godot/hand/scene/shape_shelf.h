// Keeps the cooked shapes of a scene, one for each shape of the physics server and each scale. A
// shape is cooked when it is first needed and again when its data change. Shapes that were not used
// for some time are dropped. Small shapes are cooked at once, large ones in the engine's threads.
// Main thread only.
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
    cooking, // a thread cooks it for the first time
    ready,
    // The shape cannot be rendered; why_not holds the reason.
    refused,
};

// One shape at one scale.
struct Piece {
    Vec3 scale{1.0}; // device meters per shape unit; negative x: mirrored
    PieceState state = PieceState::cooking;
    // The newest cooked shape. While cooking for the first time: one of about this scale, or null.
    std::shared_ptr<const CookedShape> shape;
    std::string why_not;
    bool told = false;         // why_not was reported
    std::uint64_t version = 0; // version of the data that it was cooked from
    std::uint64_t asked = 0;   // newest version that was sent to cooking
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
        int held = 0;    // pieces at the last removal of unused ones
        int cooking = 0; // shapes that threads cook now
        int cooked = 0;  // cooked shapes since the start
        int refused = 0; // refused shapes since the start
    };

    ShapeShelf() = default;
    ~ShapeShelf();
    ShapeShelf(const ShapeShelf &) = delete;
    ShapeShelf &operator=(const ShapeShelf &) = delete;

    // Called first in each tick: takes the results of the threads and drops unused shapes.
    void begin_tick();
    // Returns the source of a server shape, which it reads if it is new. The source stays on the
    // shelf while the caller keeps the pointer.
    [[nodiscard]] std::shared_ptr<Source> find(const godot::RID &shape);
    // Checks whether the data changed. Called once per tick for each near shape. Where the engine
    // copies its data for each read (concave shapes of GodotPhysics), large shapes are checked less
    // often.
    void look_again(Source &source);
    // Returns the piece for a scale and starts to cook it if needed. Valid until begin_tick().
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
