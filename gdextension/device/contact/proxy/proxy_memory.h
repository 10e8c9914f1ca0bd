// What the closest points of many pairs of shapes remember from cycle to cycle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/closest_points.h"

namespace spidar {

// It saves time and changes no answer (PairMemory). Large, and made where it may be allocated: not in the servo loop.
class ProxyMemory {
public:
    ProxyMemory();
    // Of this pair; another pair's is forgotten for it when there are many, and its own when a shape is another one.
    [[nodiscard]] PairMemory &of(const ToolPart &tool, const ScenePart &scene) noexcept;

    // As new.
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
