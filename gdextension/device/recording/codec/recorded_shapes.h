// Shapes in a recording. Each description is stored once, with a number, and is cooked again when
// it is read.
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

// The shapes of a recording, cooked again and found by their recorded numbers.
class RecordedShapes {
public:
    // Reads the bytes of encode_shape() and cooks the shape. Returns false when no shape can be
    // made. A shape with a known number is ignored, so that pointers stay valid until clear().
    // Allocates, and takes as long as cooking.
    [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);
    void clear() noexcept;
    // Returns null when no shape has this number.
    [[nodiscard]] const CookedShape *shape(std::uint64_t number) const noexcept;
    [[nodiscard]] const ToolShape *tool(std::uint64_t number) const noexcept;

private:
    // Ordered maps: in a malicious file, chosen numbers cannot slow the search down.
    std::map<std::uint64_t, std::shared_ptr<const CookedShape>> shapes_;
    std::map<std::uint64_t, std::shared_ptr<const ToolShape>> tools_;
};

} // namespace spidar
