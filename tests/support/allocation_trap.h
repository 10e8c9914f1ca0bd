// What the calling thread has taken from operator new, in this test program. Only differences mean something.
#pragma once

#include <cstddef>

namespace spidar::test {

[[nodiscard]] std::size_t allocations_of_this_thread() noexcept;

} // namespace spidar::test
