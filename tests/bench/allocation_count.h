// What operator new gave out since the program began (allocation_count.cpp replaces it).
#pragma once

#include <cstddef>

namespace spidar::bench {

struct Allocations {
    std::size_t count = 0;
    std::size_t bytes = 0; // asked for, never reduced by delete
};

[[nodiscard]] Allocations allocations() noexcept;

} // namespace spidar::bench
