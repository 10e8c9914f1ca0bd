#include "device/recording/codec/recorded_shapes.h"

#include <bit>
#include <utility>

#include "device/recording/codec/shape_fields.h"

namespace spidar {

namespace {

constexpr std::uint8_t kCooked = 0;
constexpr std::uint8_t kTool = 1;
constexpr int kWordBytes = 8;
constexpr int kIndexBytes = 4;

template <typename Struct>
void encode_fields(const Struct &value, ByteWriter &to) {
    for_each_field(
        value, [&to](std::string_view, int, const auto &field) { to.sparse_word(to_word(field)); });
}

template <typename Struct>
void decode_fields(ByteReader &from, Struct &value) {
    for_each_field(value, [&from](std::string_view, int, auto &field) {
        from_word(from.sparse_word(), field);
    });
}

// Reads the length of a list; 0 when the bytes for so many elements are missing.
std::size_t decode_count(ByteReader &from, std::size_t bytes_each, bool &good) {
    const std::uint64_t count = from.varint();
    good = good && from.good() && count <= from.rest().size() / bytes_each;
    return good ? static_cast<std::size_t>(count) : 0;
}

void encode_description(const ShapeDescription &shape, ByteWriter &to) {
    encode_fields(shape, to);
    to.varint(shape.points_m.size());
    for (const Vec3 &point : shape.points_m) {
        for (int axis = 0; axis < 3; ++axis) {
            to.fixed(to_word(point[axis]), kWordBytes);
        }
    }
    to.varint(shape.indices.size());
    for (const std::uint32_t index : shape.indices) {
        to.fixed(index, kIndexBytes);
    }
    to.varint(shape.heights_m.size());
    for (const float height_m : shape.heights_m) {
        to.fixed(std::bit_cast<std::uint32_t>(height_m), kIndexBytes);
    }
}

bool decode_description(ByteReader &from, ShapeDescription &shape) {
    bool good = true;
    decode_fields(from, shape);
    shape.points_m.resize(decode_count(from, std::size_t{3} * kWordBytes, good));
    for (Vec3 &point : shape.points_m) {
        for (int axis = 0; axis < 3; ++axis) {
            from_word(from.fixed(kWordBytes), point[axis]);
        }
    }
    shape.indices.resize(decode_count(from, kIndexBytes, good));
    for (std::uint32_t &index : shape.indices) {
        index = static_cast<std::uint32_t>(from.fixed(kIndexBytes));
    }
    shape.heights_m.resize(decode_count(from, kIndexBytes, good));
    for (float &height_m : shape.heights_m) {
        height_m = std::bit_cast<float>(static_cast<std::uint32_t>(from.fixed(kIndexBytes)));
    }
    return good && from.good();
}

template <typename Shape>
const Shape *find(const std::map<std::uint64_t, std::shared_ptr<const Shape>> &shapes,
                  std::uint64_t number) noexcept {
    const auto found = shapes.find(number);
    return found != shapes.end() ? found->second.get() : nullptr;
}

} // namespace

void encode_shape(const CookedShape &shape, ByteWriter &to) {
    to.fixed(kCooked, 1);
    to.varint(shape.number());
    encode_description(shape.description(), to);
}

void encode_shape(const ToolShape &tool, ByteWriter &to) {
    to.fixed(kTool, 1);
    to.varint(tool.number());
    encode_fields(tool.description(), to);
    encode_description(tool.description().shape, to);
}

bool RecordedShapes::take(std::span<const std::uint8_t> bytes) {
    ByteReader from(bytes);
    const std::uint64_t role = from.fixed(1);
    const std::uint64_t number = from.varint();
    if (role == kCooked) {
        ShapeDescription description;
        if (!decode_description(from, description)) {
            return false;
        }
        CookResult made = cook(std::move(description));
        if (made.shape != nullptr) {
            shapes_.try_emplace(number, std::move(made.shape));
            return true;
        }
        return false;
    }
    ToolDescription description;
    decode_fields(from, description);
    if (role != kTool || !decode_description(from, description.shape)) {
        return false;
    }
    ToolResult made = make_tool(description);
    if (made.tool != nullptr) {
        tools_.try_emplace(number, std::move(made.tool));
        return true;
    }
    return false;
}

void RecordedShapes::clear() noexcept {
    shapes_.clear();
    tools_.clear();
}

const CookedShape *RecordedShapes::shape(std::uint64_t number) const noexcept {
    return find(shapes_, number);
}

const ToolShape *RecordedShapes::tool(std::uint64_t number) const noexcept {
    return find(tools_, number);
}

} // namespace spidar
