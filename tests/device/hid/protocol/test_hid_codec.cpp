#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "device/hid/protocol/crc16.h"
#include "device/hid/protocol/hid_codec.h"
#include "device/hid/protocol/hid_descriptor.h"
#include "device/hid/protocol/report_sequence.h"

using namespace spidar;

namespace {

StateReport some_state() {
    StateReport report;
    report.flags = state_flag::kActuatorPower | state_flag::kZeroed;
    report.sequence = 0x1234;
    report.accepted_command = 0xFFFE;
    report.device_time_us = 0x89ABCDEF;
    for (std::size_t i = 0; i < report.counts.size(); ++i) {
        report.counts[i] = i % 2 == 0 ? -static_cast<std::int32_t>(i) - 1 : 0x7FFFFFF0 + 1;
        report.tensions_mn[i] = static_cast<std::uint16_t>(1000 * i);
    }
    report.buttons = 0x81;
    report.fault_strings = 0x10;
    report.supply_mv = 23987;
    return report;
}

CommandReport some_command() {
    CommandReport report;
    report.flags = command_flag::kEnable;
    report.sequence = 0xFFFE;
    report.valid_for_ms = 20;
    report.tensions_mn = {300, 301, 302, 303, 0, 65535, 10000, 9999};
    report.answers_state = 0x1234;
    report.host_time_us = 0xFEDCBA98;
    return report;
}

// Flipped bits of a report, most significant of byte 0 first: the order in which the CRC takes them.
template <std::size_t size>
std::array<std::uint8_t, size> flipped(std::array<std::uint8_t, size> bytes, std::size_t bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (0x80U >> (bit % 8)));
    return bytes;
}

// The CRC is linear: an error pattern passes exactly when the remainders of its bits sum to zero, and every pattern
// can be tried without decoding each. The remainders come out of the codec's own function.
std::vector<std::uint16_t> bit_remainders(std::size_t bytes) {
    std::vector<std::uint16_t> remainders;
    for (std::size_t bit = 0; bit < 8 * bytes; ++bit) {
        if (bit < 8 * (bytes - 2)) {
            std::vector<std::uint8_t> message(bytes - 2, 0);
            message[bit / 8] = static_cast<std::uint8_t>(0x80U >> (bit % 8));
            remainders.push_back(crc16(message, 0));
        } else { // a bit of the CRC itself, high byte first
            remainders.push_back(static_cast<std::uint16_t>(0x8000U >> (bit - 8 * (bytes - 2))));
        }
    }
    return remainders;
}

} // namespace

TEST_CASE("crc16: the check values of the catalogue") {
    const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    CHECK(crc16(digits, 0) == 0x31C3);      // CRC-16/XMODEM
    CHECK(crc16(digits, 0xFFFF) == 0x29B1); // CRC-16/IBM-3740
}

TEST_CASE("hid codec: what goes in comes out, at the offsets of the protocol") {
    StateReport state;
    const auto bytes = encode(some_state());
    REQUIRE(decode(bytes, state) == Decoded::ok);
    CHECK(state == some_state());
    CHECK(bytes[0] == 0x01);
    CHECK(bytes[2] == 0x34);
    CHECK(bytes[3] == 0x12);
    CHECK(bytes[6] == 0xEF);
    CHECK(bytes[10] == 0xFF); // count of string 0: -1
    CHECK(bytes[44] == 0xE8); // 1000 mN
    CHECK(bytes[58] == 0x81);
    CHECK(bytes[60] == 0xB3);

    CommandReport command;
    const auto out = encode(some_command());
    REQUIRE(decode(out, command) == Decoded::ok);
    CHECK(command == some_command());
    CHECK(out[6] == 0x2C); // 300 mN
    CHECK(out[22] == 0x34);
    CHECK(out[24] == 0x98);
    CHECK(out[28] == 0);
    CHECK(out[29] == 0);

    HidCapabilities capabilities;
    HidCapabilities other;
    other.unique_id[11] = 7;
    other.workspace_mm = {400, 300, 200};
    other.max_string_speed_mm_s = 5000;
    REQUIRE(decode(encode(other), capabilities) == Decoded::ok);
    CHECK(capabilities == other);
    other.protocol_version = 9; // another version's can be read, so that it can be named
    REQUIRE(decode(encode(other), capabilities) == Decoded::ok);
    CHECK(capabilities.protocol_version == 9);

    HidLimits limits;
    REQUIRE(decode(encode(HidLimits{10000, 1000, 5000, 100, 300}), limits) == Decoded::ok);
    CHECK(limits == HidLimits{10000, 1000, 5000, 100, 300});
    HidZero zero;
    REQUIRE(decode(encode(HidZero{some_state().counts}), zero) == Decoded::ok);
    CHECK(zero.counts == some_state().counts);
    DeviceControl control{};
    REQUIRE(decode(encode(DeviceControl::reset), control) == Decoded::ok);
    CHECK(control == DeviceControl::reset);
}

TEST_CASE("hid codec: every other length, id and version is refused, and nothing is written") {
    const auto good = encode(some_state());
    StateReport untouched;
    std::vector<std::uint8_t> bytes(good.begin(), good.end());
    for (std::size_t length = 0; length < 130; ++length) {
        bytes.resize(length, 0);
        std::copy_n(good.begin(), std::min(length, good.size()), bytes.begin());
        if (length != kStateSize) {
            CHECK(decode(bytes, untouched) == Decoded::wrong_length);
        }
    }
    auto wrong_id = good;
    wrong_id[0] = 0x03;
    CHECK(decode(wrong_id, untouched) == Decoded::wrong_id);
    for (std::uint16_t version = 0; version < 256; ++version) {
        auto sealed = good;
        const std::uint16_t crc = crc16(ReportBytes(good).first(kStateSize - 2), version);
        sealed[62] = static_cast<std::uint8_t>(crc >> 8);
        sealed[63] = static_cast<std::uint8_t>(crc);
        StateReport report;
        const bool ours = version == kHidProtocolVersion;
        CHECK(decode(sealed, report) == (ours ? Decoded::ok : Decoded::bad_crc));
    }
    CHECK(untouched == StateReport());
}

TEST_CASE("hid codec: values that no report may have are refused though the CRC fits") {
    StateReport state = some_state();
    state.sequence = kNoSequence;
    StateReport read_state;
    CHECK(decode(encode(state), read_state) == Decoded::bad_value);

    CommandReport read;
    CommandReport command = some_command();
    command.sequence = kNoSequence;
    CHECK(decode(encode(command), read) == Decoded::bad_value);
    command = some_command();
    command.valid_for_ms = 0;
    CHECK(decode(encode(command), read) == Decoded::bad_value);
    command = some_command();
    command.flags = 0x10;
    CHECK(decode(encode(command), read) == Decoded::bad_value);
    CHECK(read == CommandReport());

    HidLimits limits;
    CHECK(decode(encode(HidLimits{100, 1, 1, 1, 200}), limits) == Decoded::bad_value);
    DeviceControl control{};
    CHECK(decode(encode(static_cast<DeviceControl>(0)), control) == Decoded::bad_value);
    CHECK(decode(encode(static_cast<DeviceControl>(7)), control) == Decoded::bad_value);
}

TEST_CASE("hid codec: one and two wrong bits are refused, by the decoder itself") {
    const auto good = encode(some_command());
    CommandReport report;
    int passed = 0;
    for (std::size_t a = 0; a < 8 * good.size(); ++a) {
        const auto once = flipped(good, a);
        passed += decode(once, report) == Decoded::ok ? 1 : 0;
        for (std::size_t b = 0; b < a; ++b) {
            passed += decode(flipped(once, b), report) == Decoded::ok ? 1 : 0;
        }
    }
    CHECK(passed == 0);
}

TEST_CASE("hid codec: no error of three bits and no burst of sixteen can pass") {
    for (const std::size_t size : {kStateSize, kCommandSize}) {
        const std::vector<std::uint16_t> bits = bit_remainders(size);
        long passed = 0;
        for (std::size_t a = 0; a < bits.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                const std::uint32_t two = bits[a] ^ bits[b];
                for (std::size_t c = 0; c < b; ++c) {
                    passed += (two ^ bits[c]) == 0 ? 1 : 0;
                }
            }
        }
        CHECK(passed == 0);
        // Bursts: bits first..first + 15, the first one wrong. (With the CRC's low byte first, 12 of them would pass.)
        for (std::size_t first = 0; first < bits.size(); ++first) {
            const std::size_t rest = std::min<std::size_t>(15, bits.size() - first - 1);
            std::uint32_t sum = bits[first];
            passed += sum == 0 ? 1 : 0;
            for (std::uint32_t pattern = 1; pattern < (1U << rest);
                 ++pattern) { // Gray code: one flip each
                const auto flip = static_cast<std::size_t>(__builtin_ctz(pattern));
                sum ^= bits[first + 1 + flip];
                passed += sum == 0 ? 1 : 0;
            }
        }
        CHECK(passed == 0);
    }
}

TEST_CASE("report sequence: 0xFFFF is left out, and newer is a positive signed difference") {
    CHECK(next_sequence(0) == 1);
    CHECK(next_sequence(0xFFFD) == 0xFFFE);
    CHECK(next_sequence(0xFFFE) == 0);
    CHECK(next_sequence(kNoSequence) == 0);
    CHECK(is_newer(1, 0));
    CHECK_FALSE(is_newer(0, 0));
    CHECK_FALSE(is_newer(0, 1));
    CHECK(is_newer(0, 0xFFFE));
    CHECK_FALSE(is_newer(0x8000, 0));
    CHECK(is_newer(0x7FFF, 0));
    std::uint16_t sequence = 0xFF00;
    for (std::uint32_t steps = 1; steps <= 0x7000; ++steps) {
        sequence = next_sequence(sequence);
        REQUIRE(sequence != kNoSequence);
        REQUIRE(is_newer(sequence, 0xFF00));
        REQUIRE(sequence_steps(0xFF00, sequence) == steps);
    }
}

TEST_CASE("hid descriptor: its report sizes are those of the codec") {
    // Short items: one byte of tag, type and size, then 0, 1, 2 or 4 bytes.
    std::array<std::size_t, 256> bytes_of_id{};
    std::uint32_t id = 0;
    std::uint32_t count = 0;
    std::uint32_t bits = 0;
    std::size_t at = 0;
    int depth = 0;
    while (at < kHidReportDescriptor.size()) {
        const std::uint8_t item = kHidReportDescriptor[at++];
        const std::size_t size = std::array<std::size_t, 4>{0, 1, 2, 4}[item & 3U];
        REQUIRE(at + size <= kHidReportDescriptor.size());
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i) {
            value |= static_cast<std::uint32_t>(kHidReportDescriptor[at++]) << (8 * i);
        }
        switch (item & 0xFCU) {
        case 0x04:
            CHECK(value == kHidUsagePage);
            break;
        case 0x74:
            bits = value;
            break;
        case 0x84:
            id = value;
            break;
        case 0x94:
            count = value;
            break;
        case 0x80:
        case 0x90:
        case 0xB0:
            bytes_of_id.at(id) = 1 + bits * count / 8;
            break;
        case 0xA0:
            ++depth;
            break;
        case 0xC0:
            --depth;
            break;
        default:
            break;
        }
    }
    CHECK(depth == 0);
    CHECK(bytes_of_id[0x01] == kStateSize);
    CHECK(bytes_of_id[0x02] == kCommandSize);
    CHECK(bytes_of_id[0x10] == kCapabilitiesSize);
    CHECK(bytes_of_id[0x11] == kLimitsSize);
    CHECK(bytes_of_id[0x12] == kZeroSize);
    CHECK(bytes_of_id[0x13] == kDeviceControlSize);
    CHECK(*std::max_element(bytes_of_id.begin(), bytes_of_id.end()) <= kLargestReport);
}
