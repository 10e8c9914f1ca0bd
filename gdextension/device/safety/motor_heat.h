// How warm the motors of each device are while no loop watches them: a device that is opened anew is as warm as it was
// left, less what it has cooled since. For this process; a device is known by its name (Transport::device_name()).
#pragma once

#include <cstdint>
#include <string>

#include "core/base/types.h"

namespace spidar {

// heat: share of each motor's thermal budget (ThermalBudget::heat()). now_ns: of monotonic_ns(). Without a name nothing
// is kept. Both lock a mutex and may allocate: not from a servo cycle.
void keep_motor_heat(const std::string &device, const StringArray &heat, double thermal_time_s,
                     std::int64_t now_ns);
[[nodiscard]] StringArray recall_motor_heat(const std::string &device, std::int64_t now_ns);

} // namespace spidar
