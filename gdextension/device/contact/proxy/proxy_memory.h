// What the closest points of many pairs of shapes remember from cycle to cycle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "device/contact/shapes/closest_points.h"

namespace spidar {

// It saves time and changes no answer (PairMemory). Large, and made where it may be allocated: not in the servo loop.
class ProxyMemory {
public:
    ProxyMemory();
    // Of this pair; another pair's is forgotten for it when there are many.
    [[nodiscard]] PairMemory &of(std::int32_t tool_id, std::int32_t scene_id) noexcept;

private:
    static constexpr std::size_t kPairs = 32;
    struct Slot {
        std::int32_t tool_id = 0;
        std::int32_t scene_id = 0;
        std::uint64_t used = 0;
        PairMemory memory;
    };
    std::unique_ptr<std::array<Slot, kPairs>> slots_;
    std::uint64_t clock_ = 0;
};

} // namespace spidar
