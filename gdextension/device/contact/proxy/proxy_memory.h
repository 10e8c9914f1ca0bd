// Memory of the closest points of many pairs of shapes, from cycle to cycle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/closest_points.h"

namespace spidar {

// It saves time and changes no answer (see PairMemory). Large: allocate it outside the servo loop.
class ProxyMemory {
public:
    ProxyMemory();
    // Returns the memory of a pair. When all are in use, another pair is forgotten. The memory
    // restarts when a shape of the pair has changed.
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
