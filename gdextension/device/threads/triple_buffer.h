// Newest-value mailbox between one writing and one reading thread. Wait-free on both sides: neither ever
// retries, so a slow reader cannot hold the servo loop up, and a value is never torn. Values that are not
// fetched in time are dropped: newest wins.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace spidar {

template <typename T>
class TripleBuffer {
    static_assert(std::is_nothrow_copy_assignable_v<T>);

public:
    // From the writing thread only.
    void write(const T &value) noexcept {
        slots_[back_].value = value;
        // Release hands the slot's contents over; acquire takes back what the reader has finished with.
        const std::uint8_t taken =
            middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel);
        back_ = taken & kIndexMask;
    }

    // From the reading thread only. True when a value has come since the last read; else `value` is untouched.
    bool read(T &value) noexcept {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
            return false;
        }
        const std::uint8_t taken = middle_.exchange(front_, std::memory_order_acq_rel);
        front_ = taken & kIndexMask;
        value = slots_[front_].value;
        return true;
    }

private:
    static constexpr std::uint8_t kIndexMask = 3;
    static constexpr std::uint8_t kFresh = 4;
    // Each slot on its own cache lines: writer and reader work on different slots at the same time.
    struct alignas(64) Slot {
        T value{};
    };
    std::array<Slot, 3> slots_{};
    alignas(64) std::uint8_t back_ = 0; // the writer's
    alignas(64) std::atomic<std::uint8_t> middle_{1};
    alignas(64) std::uint8_t front_ = 2; // the reader's
};

} // namespace spidar
