// CRC-16 of the HID reports: polynomial x^16 + x^12 + x^5 + 1 (0x1021), not reflected, no final
// xor. In reports of this length, whose CRC is sent high byte first, it detects every error of up
// to three bits and every burst of up to sixteen (P. Koopman, "32-bit cyclic redundancy codes for
// internet applications", 2002, and the usual tables for 0x1021).
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace spidar {

namespace crc16_detail {

[[nodiscard]] constexpr std::array<std::uint16_t, 256> make_table() noexcept {
    constexpr std::uint32_t kPolynomial = 0x1021;
    std::array<std::uint16_t, 256> table{};
    for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
        std::uint32_t remainder = byte << 8U;
        for (int bit = 0; bit < 8; ++bit) {
            const bool carries = (remainder & 0x8000U) != 0;
            remainder = ((remainder << 1U) ^ (carries ? kPolynomial : 0U)) & 0xFFFFU;
        }
        table[byte] = static_cast<std::uint16_t>(remainder);
    }
    return table;
}
inline constexpr std::array<std::uint16_t, 256> kTable = make_table();

} // namespace crc16_detail

// Returns the CRC of `bytes`. seed: the protocol version, so that reports of another version fail
// the check; 0 for capabilities, which every version must be able to read.
[[nodiscard]] constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes,
                                            std::uint16_t seed) noexcept {
    std::uint32_t remainder = seed;
    for (const std::uint8_t byte : bytes) {
        const std::uint32_t index = ((remainder >> 8U) ^ byte) & 0xFFU;
        remainder = ((remainder << 8U) ^ crc16_detail::kTable[index]) & 0xFFFFU;
    }
    return static_cast<std::uint16_t>(remainder);
}

} // namespace spidar
