// The HID report descriptor of a SPIDAR-G controller, to be copied into firmware.
// docs/reference/hid_protocol.md shows the same bytes; a test compares the two.
#pragma once

#include <array>
#include <cstdint>

namespace spidar {

// clang-format off
inline constexpr std::array<std::uint8_t, 63> kHidReportDescriptor = {
    0x06, 0x00, 0xFF, // Usage Page (vendor defined 0xFF00)
    0x09, 0x01,       // Usage (0x01)
    0xA1, 0x01,       // Collection (Application)
    0x15, 0x00,       //   Logical Minimum (0)
    0x26, 0xFF, 0x00, //   Logical Maximum (255)
    0x75, 0x08,       //   Report Size (8 bits)
    0x85, 0x01,       //   Report ID (0x01): STATE
    0x09, 0x02,       //   Usage (0x02)
    0x95, 0x3F,       //   Report Count (63)
    0x81, 0x02,       //   Input (Data, Variable, Absolute)
    0x85, 0x02,       //   Report ID (0x02): COMMAND
    0x09, 0x03,       //   Usage (0x03)
    0x95, 0x1F,       //   Report Count (31)
    0x91, 0x02,       //   Output (Data, Variable, Absolute)
    0x85, 0x10,       //   Report ID (0x10): CAPABILITIES
    0x09, 0x10,       //   Usage (0x10)
    0x95, 0x3F,       //   Report Count (63)
    0xB1, 0x02,       //   Feature (Data, Variable, Absolute)
    0x85, 0x11,       //   Report ID (0x11): LIMITS
    0x09, 0x11,       //   Usage (0x11)
    0x95, 0x0F,       //   Report Count (15)
    0xB1, 0x02,       //   Feature (Data, Variable, Absolute)
    0x85, 0x12,       //   Report ID (0x12): ZERO
    0x09, 0x12,       //   Usage (0x12)
    0x95, 0x27,       //   Report Count (39)
    0xB1, 0x02,       //   Feature (Data, Variable, Absolute)
    0x85, 0x13,       //   Report ID (0x13): DEVICE CONTROL
    0x09, 0x13,       //   Usage (0x13)
    0x95, 0x03,       //   Report Count (3)
    0xB1, 0x02,       //   Feature (Data, Variable, Absolute)
    0xC0,             // End Collection
};
// clang-format on

} // namespace spidar
