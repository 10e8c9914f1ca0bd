// What SpidarG.get_device_info() and SpidarG.list_devices() return on serial motor boards.
#pragma once

#include <string>

#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "device/serial/serial_transport.h"

namespace spidar {

// Returns the boards of an open transport, such as "B5M with id 1, B3M with id 2".
[[nodiscard]] std::string serial_boards_text(const SerialTransport &transport);
// Sets the fields of SpidarG.get_device_info() that serial boards have.
void describe_serial(const SerialTransport &transport, double rate_hz, godot::Dictionary &info);
// Appends an entry to the result of SpidarG.list_devices() for each serial port on USB.
void list_serial_ports(godot::Array &list);

} // namespace spidar
