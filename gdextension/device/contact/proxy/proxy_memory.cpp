#include "device/contact/proxy/proxy_memory.h"

namespace spidar {

ProxyMemory::ProxyMemory() : slots_(std::make_unique<std::array<Slot, kPairs>>()) {}

PairMemory &ProxyMemory::of(std::int32_t tool_id, std::int32_t scene_id) noexcept {
    ++clock_;
    Slot *oldest = slots_->data();
    for (Slot &slot : *slots_) {
        if (slot.used != 0 && slot.tool_id == tool_id && slot.scene_id == scene_id) {
            slot.used = clock_;
            return slot.memory;
        }
        oldest = slot.used < oldest->used ? &slot : oldest;
    }
    oldest->tool_id = tool_id;
    oldest->scene_id = scene_id;
    oldest->used = clock_;
    oldest->memory.forget();
    return oldest->memory;
}

} // namespace spidar
