// What a recording has come to.
#pragma once

#include <cstdint>

namespace spidar {

struct RecorderStatistics {
    std::uint64_t cycles = 0; // handed over
    std::uint64_t lost = 0;   // the ring was full; marked in the file
    std::uint64_t bytes = 0;  // written
    bool failed = false;      // the file could not be written any further
};

} // namespace spidar
