// Memory from cycle to cycle for the closest points of many pairs of a tool part and a scene part.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/closest_points.h"

namespace spidar {

// It saves time; without it, answers change by less than the errors in closest_points.h. It
// allocates 3 MB: create it outside the servo loop.
class ProxyMemory {
public:
    ProxyMemory();
    // Returns the memory of a pair. If all memories are in use, the pair that was not used for
    // longest is forgotten. If a part of the pair has got another shape, the memory is emptied.
    [[nodiscard]] PairMemory &of(const ToolPart &tool, const ScenePart &scene) noexcept;

    // Forgets all pairs.
    void forget() noexcept;

private:
    static constexpr std::size_t kPairs = 64;
    struct Slot {
        std::array<std::uint64_t, 2> ids{};
        std::array<std::uint64_t, 2> shapes{}; // their numbers
        std::uint64_t used = 0;
        PairMemory memory;
    };
    std::unique_ptr<std::array<Slot, kPairs>> slots_;
    std::uint64_t clock_ = 0;
};

} // namespace spidar
