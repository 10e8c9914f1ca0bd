// Converts reports to bytes and back. decode() checks length, report id, CRC and values in this
// order, and writes `report` only when all are valid. Never throws or allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

enum class Decoded : std::uint8_t { ok, wrong_length, wrong_id, bad_crc, bad_value };

using ReportBytes = std::span<const std::uint8_t>;

[[nodiscard]] std::array<std::uint8_t, kStateSize> encode(const StateReport &report) noexcept;
[[nodiscard]] std::array<std::uint8_t, kCommandSize> encode(const CommandReport &report) noexcept;
[[nodiscard]] std::array<std::uint8_t, kCapabilitiesSize>
encode(const HidCapabilities &report) noexcept;
[[nodiscard]] std::array<std::uint8_t, kLimitsSize> encode(const HidLimits &report) noexcept;
[[nodiscard]] std::array<std::uint8_t, kZeroSize> encode(const HidZero &report) noexcept;
[[nodiscard]] std::array<std::uint8_t, kDeviceControlSize> encode(DeviceControl report) noexcept;

[[nodiscard]] Decoded decode(ReportBytes bytes, StateReport &report) noexcept;
[[nodiscard]] Decoded decode(ReportBytes bytes, CommandReport &report) noexcept;
// Accepts every protocol version; the caller must compare protocol_version.
[[nodiscard]] Decoded decode(ReportBytes bytes, HidCapabilities &report) noexcept;
[[nodiscard]] Decoded decode(ReportBytes bytes, HidLimits &report) noexcept;
[[nodiscard]] Decoded decode(ReportBytes bytes, HidZero &report) noexcept;
[[nodiscard]] Decoded decode(ReportBytes bytes, DeviceControl &report) noexcept;

} // namespace spidar
