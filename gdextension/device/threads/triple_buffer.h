// Passes the newest value from one writing to one reading thread; it replaces older values that
// were not read. Wait-free on both sides: no side retries, so that a slow reader cannot delay the
// servo loop. A value is always read whole.
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
    // Publishes a value. Called from the writing thread only.
    void write(const T &value) noexcept {
        slots_[back_].value = value;
        // Release publishes the slot's contents; acquire takes back the slot the reader left.
        const std::uint8_t taken =
            middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel);
        back_ = taken & kIndexMask;
    }

    // Reads the newest value; called from the reading thread only. Returns false and leaves `value`
    // unchanged when there is no new one.
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
    // Each slot has its own cache lines: writer and reader use different slots at the same time.
    struct alignas(64) Slot {
        T value{};
    };
    std::array<Slot, 3> slots_{};
    alignas(64) std::uint8_t back_ = 0; // owned by the writer
    alignas(64) std::atomic<std::uint8_t> middle_{1};
    alignas(64) std::uint8_t front_ = 2; // owned by the reader
};

} // namespace spidar
