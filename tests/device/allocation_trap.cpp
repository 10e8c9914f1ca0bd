// Counts for the whole test program. The nothrow form too: std::stable_sort uses it, and what it gives goes to the
// delete below, which a sanitizer checks. And the aligned form: loops and rings have cache lines of their own.
#include "device/allocation_trap.h"

#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t allocations = 0;

} // namespace

void *operator new(std::size_t size, const std::nothrow_t &) noexcept {
    ++allocations;
    return std::malloc(size > 0 ? size : 1);
}
void *operator new(std::size_t size) {
    if (void *const memory = ::operator new(size, std::nothrow)) {
        return memory;
    }
    throw std::bad_alloc();
}
void *operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto step = static_cast<std::size_t>(alignment);
    if (void *const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::align_val_t) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}

std::size_t spidar::test::allocations_of_this_thread() noexcept {
    return allocations;
}
