#include "device/contact/proxy/proxy_memory.h"

namespace spidar {

ProxyMemory::ProxyMemory() : slots_(std::make_unique<std::array<Slot, kPairs>>()) {}

PairMemory &ProxyMemory::of(const ToolPart &tool, const ScenePart &scene) noexcept {
    ++clock_;
    const std::array<std::uint64_t, 2> ids{static_cast<std::uint64_t>(tool.id),
                                           static_cast<std::uint64_t>(scene.id)};
    const std::array<std::uint64_t, 2> shapes{tool.shape->number(), scene.shape->number()};
    Slot *chosen = slots_->data();
    for (Slot &slot : *slots_) {
        if (slot.used != 0 && slot.ids == ids) {
            chosen = &slot;
            break;
        }
        chosen = slot.used < chosen->used ? &slot : chosen;
    }
    if (chosen->ids != ids || chosen->shapes != shapes) {
        chosen->ids = ids;
        chosen->shapes = shapes;
        chosen->memory.forget();
    }
    chosen->used = clock_;
    return chosen->memory;
}

void ProxyMemory::forget() noexcept {
    for (Slot &slot : *slots_) {
        slot.ids = {};
        slot.shapes = {};
        slot.used = 0;
        slot.memory.forget();
    }
    clock_ = 0;
}

} // namespace spidar
