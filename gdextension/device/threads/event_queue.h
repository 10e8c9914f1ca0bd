// Events from the servo thread to one reading thread, in order. Wait-free on both sides; when nobody reads, the
// newest are dropped and counted.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/contract/device_event.h"

namespace spidar {

class EventQueue {
public:
    static constexpr std::uint32_t kPlaces = 256;

    // From the writing thread only.
    void push(const DeviceEvent &event) noexcept {
        const std::uint32_t end = end_.load(std::memory_order_relaxed);
        if (end - begin_.load(std::memory_order_acquire) >= kPlaces) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return;
        }
        ring_[end % kPlaces] = event;
        end_.store(end + 1, std::memory_order_release);
    }
    // From the reading thread only. False: none is waiting.
    bool pop(DeviceEvent &event) noexcept {
        const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) {
            return false;
        }
        event = ring_[begin % kPlaces];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }
    [[nodiscard]] std::uint32_t dropped() const noexcept {
        return dropped_.load(std::memory_order_relaxed);
    }

private:
    std::array<DeviceEvent, kPlaces> ring_{};
    alignas(64) std::atomic<std::uint32_t> begin_{0};
    alignas(64) std::atomic<std::uint32_t> end_{0};
    std::atomic<std::uint32_t> dropped_{0};
};

} // namespace spidar
