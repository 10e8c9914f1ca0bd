#include "bench/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocation_count{0};
std::atomic<std::size_t> allocated_bytes{0};

void *counted(std::size_t size) {
    allocation_count.fetch_add(1, std::memory_order_relaxed);
    allocated_bytes.fetch_add(size, std::memory_order_relaxed);
    void *memory = std::malloc(size);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

void *counted_aligned(std::size_t size, std::align_val_t alignment) {
    allocation_count.fetch_add(1, std::memory_order_relaxed);
    allocated_bytes.fetch_add(size, std::memory_order_relaxed);
    const auto step = static_cast<std::size_t>(alignment);
    void *memory = std::aligned_alloc(step, (size + step - 1) / step * step);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

} // namespace

void *operator new(std::size_t size) {
    return counted(size);
}
void *operator new[](std::size_t size) {
    return counted(size);
}
void *operator new(std::size_t size, std::align_val_t alignment) {
    return counted_aligned(size, alignment);
}
void *operator new[](std::size_t size, std::align_val_t alignment) {
    return counted_aligned(size, alignment);
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete[](void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
void operator delete[](void *memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete[](void *memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete[](void *memory, std::size_t /*size*/,
                       std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}

namespace spidar::bench {

Allocations allocations() noexcept {
    return {allocation_count.load(std::memory_order_relaxed),
            allocated_bytes.load(std::memory_order_relaxed)};
}

} // namespace spidar::bench
