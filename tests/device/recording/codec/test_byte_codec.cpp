// Numbers as bytes and back; the check value of CRC-32.
#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <string_view>

#include "device/recording/codec/byte_codec.h"

using namespace spidar;

namespace {

std::vector<std::uint8_t> bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

} // namespace

TEST_CASE("crc32: the published check value, in one piece and in two") {
    const auto whole = bytes_of("123456789");
    CHECK(crc32(whole) == 0xCBF43926U);
    const std::span<const std::uint8_t> all(whole);
    CHECK(crc32(all.subspan(4), crc32(all.first(4))) == 0xCBF43926U);
    CHECK(crc32({}) == 0);
}

TEST_CASE("byte codec: every kind of number comes back, and nothing is left over") {
    std::mt19937_64 random(7);
    std::vector<std::uint64_t> values = {0, 1, 127, 128, 0xFF00, UINT64_MAX, 1ULL << 63U};
    for (int i = 0; i < 2000; ++i) {
        values.push_back(random() >> (random() % 64));
        values.push_back(random() << (random() % 64));
    }
    std::vector<std::uint8_t> bytes;
    ByteWriter to(bytes);
    for (const std::uint64_t value : values) {
        to.varint(value);
        to.signed_varint(static_cast<std::int64_t>(value));
        to.sparse_word(value);
        to.fixed(value, 8);
        to.fixed(value, 3);
    }
    ByteReader from(bytes);
    for (const std::uint64_t value : values) {
        CHECK(from.varint() == value);
        CHECK(from.signed_varint() == static_cast<std::int64_t>(value));
        CHECK(from.sparse_word() == value);
        CHECK(from.fixed(8) == value);
        CHECK(from.fixed(3) == (value & 0xFFFFFFU));
    }
    CHECK(from.good());
    CHECK(from.empty());
}

TEST_CASE("byte codec: small changes are short") {
    std::vector<std::uint8_t> bytes;
    ByteWriter(bytes).signed_varint(-64);
    CHECK(bytes.size() == 1);
    bytes.clear();
    ByteWriter(bytes).sparse_word(0x00AB000000000000U);
    CHECK(bytes.size() == 2);
    bytes.clear();
    ByteWriter(bytes).sparse_word(0);
    CHECK(bytes.size() == 1);
}

TEST_CASE("byte codec: past the end there are zeros, and good() is false") {
    const std::vector<std::uint8_t> bytes = {0x80, 0x80};
    ByteReader from(bytes);
    CHECK(from.varint() == 0);
    CHECK_FALSE(from.good());
    CHECK(from.fixed(8) == 0);
    CHECK_FALSE(from.good());

    ByteReader endless(std::span<const std::uint8_t>(bytes).first(0));
    CHECK(endless.sparse_word() == 0);
    CHECK_FALSE(endless.good());

    // A word of more than 8 bytes, and a number that never ends.
    const std::vector<std::uint8_t> wide = {0x58, 1, 2, 3, 4, 5, 6, 7, 8};
    ByteReader too_wide(wide);
    CHECK(too_wide.sparse_word() == 0);
    CHECK_FALSE(too_wide.good());
    const std::vector<std::uint8_t> ones(20, 0xFF);
    ByteReader too_long(ones);
    CHECK(too_long.varint() == 0);
    CHECK_FALSE(too_long.good());
}

TEST_CASE("byte codec: zigzag keeps small numbers of either sign small") {
    CHECK(zigzag(0) == 0);
    CHECK(zigzag(-1) == 1);
    CHECK(zigzag(1) == 2);
    for (const std::int64_t value : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-2},
                                     std::numeric_limits<std::int64_t>::max()}) {
        CHECK(from_zigzag(zigzag(value)) == value);
    }
}
