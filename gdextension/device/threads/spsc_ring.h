// Queue between one writing and one reading thread. Wait-free on both sides; memory is allocated
// once, in the constructor. A full queue takes no new element.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

namespace spidar {

template <typename T>
class SpscRing {
public:
    // Rounds the capacity up to a power of two.
    explicit SpscRing(std::size_t capacity) : slots_(std::bit_ceil(capacity)) {}

    [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

    // Writing thread: returns the place of the next element, or null when the queue is full.
    // commit() publishes the element.
    [[nodiscard]] T *free_slot() noexcept {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (tail - known_head_ >= slots_.size()) {
            known_head_ = head_.load(std::memory_order_acquire);
            if (tail - known_head_ >= slots_.size()) {
                return nullptr;
            }
        }
        return &slots_[tail & (slots_.size() - 1)];
    }
    void commit() noexcept {
        tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

    // Reading thread: the oldest element, null when the queue is empty. pop() removes it.
    [[nodiscard]] const T *oldest() noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == known_tail_) {
            known_tail_ = tail_.load(std::memory_order_acquire);
            if (head == known_tail_) {
                return nullptr;
            }
        }
        return &slots_[head & (slots_.size() - 1)];
    }
    void pop() noexcept {
        head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }

    // Writing thread: adds a copy of an element. Returns false and drops it when the queue is full.
    bool offer(const T &element) noexcept {
        T *const slot = free_slot();
        if (slot == nullptr) {
            return false;
        }
        *slot = element;
        commit();
        return true;
    }
    // Reading thread: copies and removes the oldest element. Returns false when there is none.
    bool take(T &element) noexcept {
        const T *const waiting = oldest();
        if (waiting == nullptr) {
            return false;
        }
        element = *waiting;
        pop();
        return true;
    }

    // Number of waiting elements; callable from either thread. The other side may be changing it.
    [[nodiscard]] std::size_t size() const noexcept {
        const std::size_t head = head_.load(std::memory_order_acquire);
        return tail_.load(std::memory_order_acquire) - head;
    }

private:
    std::vector<T> slots_;
    // Each thread has its own cache lines, with the position of the other thread as it last read
    // it.
    alignas(64) std::atomic<std::size_t> tail_{0};
    std::size_t known_head_ = 0;
    alignas(64) std::atomic<std::size_t> head_{0};
    std::size_t known_tail_ = 0;
};

} // namespace spidar
