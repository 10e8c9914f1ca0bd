// Information about serial motor boards and their ports for a game.
#pragma once

#include <string>

#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "device/serial/serial_transport.h"

namespace spidar {

// Returns "B5M with id 1, B3M with id 2".
[[nodiscard]] std::string serial_boards_text(const SerialTransport &transport);
// Adds the fields of SpidarG.get_device_info() that only serial boards have.
void describe_serial(const SerialTransport &transport, double rate_hz, godot::Dictionary &info);
// Appends an entry of SpidarG.list_devices() for each port of a USB bridge.
void list_serial_ports(godot::Array &list);

} // namespace spidar
