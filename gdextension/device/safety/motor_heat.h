// Keeps the heat of each device's motors while no loop runs, and lets it cool, so that a device
// that is opened again does not start cold. It is kept until the process ends, under the device's
// name (Transport::device_name()).
#pragma once

#include <cstdint>
#include <string>

#include "core/base/types.h"

namespace spidar {

// Stores the heat. heat: share of each motor's budget (ThermalBudget::heat()). now_ns: time of
// monotonic_ns(). Without a name nothing is stored. Locks a mutex and may allocate: not for a servo
// cycle.
void keep_motor_heat(const std::string &device, const StringArray &heat, double thermal_time_s,
                     std::int64_t now_ns);
// Returns the stored heat after cooling, or zeros. Locks a mutex: not for a servo cycle.
[[nodiscard]] StringArray recall_motor_heat(const std::string &device, std::int64_t now_ns);

} // namespace spidar
