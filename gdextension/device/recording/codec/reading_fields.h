// List of the fields of a DeviceReading except its counts. Clock and sequence number must stay the
// first two (cycle_codec.cpp); new fields must be added at the end.
#pragma once

#include "device/contract/transport.h"
#include "device/recording/codec/field_words.h"

namespace spidar {

static_assert(count_members<DeviceReading>() == 9, "DeviceReading changed: list its fields here");

template <typename Reading, typename Visit>
void for_each_field(Reading &reading, Visit &&visit) requires
    std::is_same_v<std::remove_const_t<Reading>, DeviceReading> {
    visit("device_time_us", 0, reading.device_time_us);
    visit("sequence", 0, reading.sequence);
    visit("buttons", 0, reading.buttons);
    visit("zeroed", 0, reading.zeroed);
    visit("device_status", 0, reading.device_status);
    visit("fault_strings", 0, reading.fault_strings);
    visit("overtaken", 0, reading.overtaken);
    visit_array("sensors", reading.sensors, visit);
}

} // namespace spidar
