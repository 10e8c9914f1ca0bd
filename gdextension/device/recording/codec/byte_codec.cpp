#include "device/recording/codec/byte_codec.h"

#include <array>
#include <bit>

namespace spidar {

namespace {

constexpr unsigned kByteBits = 8;
constexpr std::uint64_t kByteMask = 0xFF;
constexpr unsigned kVarintBits = 7;
constexpr std::uint64_t kVarintMask = 0x7F;
constexpr unsigned kMore = 0x80;
constexpr unsigned kWordBits = 64;

constexpr std::array<std::uint32_t, 256> make_crc_table() noexcept {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        std::uint32_t value = i;
        for (unsigned bit = 0; bit < kByteBits; ++bit) {
            value = (value & 1U) != 0 ? (value >> 1U) ^ 0xEDB88320U : value >> 1U;
        }
        table[i] = value;
    }
    return table;
}

constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

} // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) noexcept {
    std::uint32_t value = ~before;
    for (const std::uint8_t byte : bytes) {
        value = kCrcTable[(value ^ byte) & kByteMask] ^ (value >> kByteBits);
    }
    return ~value;
}

void ByteWriter::fixed(std::uint64_t value, int size_bytes) {
    for (int i = 0; i < size_bytes; ++i) {
        bytes_.push_back(static_cast<std::uint8_t>(value & kByteMask));
        value >>= kByteBits;
    }
}

void ByteWriter::varint(std::uint64_t value) {
    while (value > kVarintMask) {
        bytes_.push_back(static_cast<std::uint8_t>((value & kVarintMask) | kMore));
        value >>= kVarintBits;
    }
    bytes_.push_back(static_cast<std::uint8_t>(value));
}

void ByteWriter::sparse_word(std::uint64_t value) {
    // High half of the first byte: number of zero bytes at the low end. Low half: number of bytes
    // that follow.
    const unsigned low =
        value == 0 ? 0U : static_cast<unsigned>(std::countr_zero(value)) / kByteBits;
    const unsigned high = static_cast<unsigned>(std::countl_zero(value)) / kByteBits;
    const unsigned size = value == 0 ? 0U : kWordBits / kByteBits - low - high;
    bytes_.push_back(static_cast<std::uint8_t>((low << 4U) | size));
    fixed(value >> (low * kByteBits), static_cast<int>(size));
}

void ByteWriter::raw(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::uint8_t ByteReader::next() noexcept {
    if (rest_.empty()) {
        good_ = false;
        return 0;
    }
    const std::uint8_t byte = rest_.front();
    rest_ = rest_.subspan(1);
    return byte;
}

std::uint64_t ByteReader::fixed(int size_bytes) noexcept {
    std::uint64_t value = 0;
    for (int i = 0; i < size_bytes; ++i) {
        value |= static_cast<std::uint64_t>(next()) << (kByteBits * static_cast<unsigned>(i));
    }
    return value;
}

std::uint64_t ByteReader::varint() noexcept {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < kWordBits; shift += kVarintBits) {
        const std::uint8_t byte = next();
        value |= (byte & kVarintMask) << shift;
        if ((byte & kMore) == 0) {
            return value;
        }
    }
    good_ = false; // no number is this long
    return 0;
}

std::uint64_t ByteReader::sparse_word() noexcept {
    const unsigned head = next();
    const unsigned low = head >> 4U;
    const unsigned size = head & 0xFU;
    if (low + size > kWordBits / kByteBits || (size == 0 && low != 0)) {
        good_ = false;
        return 0;
    }
    const std::uint64_t value = fixed(static_cast<int>(size));
    return size == 0 ? 0 : value << (low * kByteBits);
}

} // namespace spidar
