// What a servo cycle takes in from outside, beside the game's command.
#pragma once

#include "device/contract/transport.h"

namespace spidar {

struct CycleInput {
    DeviceReading reading; // stays what it was when nothing new came
    double dt_s = 0.001;
    Status read_status = Status::ok;
    Status write_status = Status::ok; // of what this cycle sends: for ServoStep::report_write()
    bool may_arm_itself = false;
};

} // namespace spidar
