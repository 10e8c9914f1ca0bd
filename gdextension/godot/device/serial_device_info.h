// What a game is told of serial motor boards and of the ports that they may be on.
#pragma once

#include <string>

#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "device/serial/serial_transport.h"

namespace spidar {

// "B5M with id 1, B3M with id 2".
[[nodiscard]] std::string serial_boards_text(const SerialTransport &transport);
// The fields of SpidarG.get_device_info() that only serial boards have.
void describe_serial(const SerialTransport &transport, double rate_hz, godot::Dictionary &info);
// Appends an entry of SpidarG.list_devices() for each port of a USB bridge.
void list_serial_ports(godot::Array &list);

} // namespace spidar
