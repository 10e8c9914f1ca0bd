// Counts for the whole test program. The nothrow form too: std::stable_sort uses it, and what it gives goes to the
// delete below, which a sanitizer checks. And the aligned form: loops and rings have cache lines of their own.
#include "support/allocation_trap.h"

#include <cstdlib>
#include <new>
#ifdef _WIN32
#include <malloc.h>
#endif

namespace {

thread_local std::size_t allocations = 0;

// Windows has no std::aligned_alloc, and its aligned memory has a free() of its own.
void *take_aligned(std::size_t size, std::size_t step) {
#ifdef _WIN32
    return _aligned_malloc(size, step);
#else
    return std::aligned_alloc(step, (size + step - 1) / step * step);
#endif
}

void give_aligned(void *memory) {
#ifdef _WIN32
    _aligned_free(memory);
#else
    std::free(memory);
#endif
}

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
    if (void *const memory = take_aligned(size, static_cast<std::size_t>(alignment))) {
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
    give_aligned(memory);
}
void operator delete(void *memory, std::size_t, std::align_val_t) noexcept {
    give_aligned(memory);
}

std::size_t spidar::test::allocations_of_this_thread() noexcept {
    return allocations;
}
