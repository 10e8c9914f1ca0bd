// Shapes in a recording: each is kept once, as the description that it was cooked from, under its number.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/tool_shape.h"
#include "device/recording/codec/byte_codec.h"

namespace spidar {

void encode_shape(const CookedShape &shape, ByteWriter &to);
void encode_shape(const ToolShape &tool, ByteWriter &to);

// The shapes of a recording, cooked again, by the numbers that they had when they were recorded.
class RecordedShapes {
public:
    // What encode_shape() wrote. False: no shape can be made of it. Allocates, and takes as long as cooking does. A shape
    // whose number is known already is left out: pointers to the first one stay good until clear().
    [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);
    void clear() noexcept;
    // Null: there is none of this number.
    [[nodiscard]] const CookedShape *shape(std::uint64_t number) const noexcept;
    [[nodiscard]] const ToolShape *tool(std::uint64_t number) const noexcept;

private:
    // Trees: numbers that were chosen to do harm make no search slow.
    std::map<std::uint64_t, std::shared_ptr<const CookedShape>> shapes_;
    std::map<std::uint64_t, std::shared_ptr<const ToolShape>> tools_;
};

} // namespace spidar
