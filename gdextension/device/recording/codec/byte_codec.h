// Numbers as bytes in a recording file, little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace spidar {

// Returns CRC-32 (ISO-HDLC: polynomial 0xEDB88320, reflected), continued from `before`. "123456789"
// gives 0xCBF43926.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes,
                                  std::uint32_t before = 0) noexcept;

// Maps signed numbers near 0 to small unsigned ones: 0, -1, 1, -2 to 0, 1, 2, 3.
[[nodiscard]] constexpr std::uint64_t zigzag(std::int64_t value) noexcept {
    return (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U);
}
// Inverse of zigzag().
[[nodiscard]] constexpr std::int64_t from_zigzag(std::uint64_t value) noexcept {
    return static_cast<std::int64_t>((value >> 1U) ^ (~(value & 1U) + 1U));
}

class ByteWriter {
public:
    explicit ByteWriter(std::vector<std::uint8_t> &bytes) noexcept : bytes_(bytes) {}

    void fixed(std::uint64_t value, int size_bytes);
    // Writes 7 bits per byte: 1 byte below 128, at most 10.
    void varint(std::uint64_t value);
    void signed_varint(std::int64_t value) { varint(zigzag(value)); }
    // Writes a 64-bit word that has many zero bytes: one byte that states which bytes follow, then
    // the bytes from the first to the last nonzero one.
    void sparse_word(std::uint64_t value);
    void raw(std::span<const std::uint8_t> bytes);

private:
    std::vector<std::uint8_t> &bytes_;
};

// Reads what ByteWriter wrote. Bytes past the end count as zero, and good() is false from then on.
class ByteReader {
public:
    ByteReader() noexcept = default;
    explicit ByteReader(std::span<const std::uint8_t> bytes) noexcept : rest_(bytes) {}

    [[nodiscard]] std::uint64_t fixed(int size_bytes) noexcept;
    [[nodiscard]] std::uint64_t varint() noexcept;
    [[nodiscard]] std::int64_t signed_varint() noexcept { return from_zigzag(varint()); }
    [[nodiscard]] std::uint64_t sparse_word() noexcept;

    [[nodiscard]] bool good() const noexcept { return good_; }
    [[nodiscard]] bool empty() const noexcept { return rest_.empty(); }
    [[nodiscard]] std::span<const std::uint8_t> rest() const noexcept { return rest_; }

private:
    std::uint8_t next() noexcept;

    std::span<const std::uint8_t> rest_;
    bool good_ = true;
};

} // namespace spidar
