// The rate of physics ticks in this project; 60 per second, the engine's default, if it reports
// none.
#pragma once

#include <cstdint>

#include <godot_cpp/classes/engine.hpp>

namespace spidar {

[[nodiscard]] inline std::uint32_t physics_ticks_per_second() {
    constexpr std::uint32_t kDefault = 60;
    const int hz = godot::Engine::get_singleton()->get_physics_ticks_per_second();
    return hz > 0 ? static_cast<std::uint32_t>(hz) : kDefault;
}
[[nodiscard]] inline double physics_tick_s() {
    return 1.0 / physics_ticks_per_second();
}

} // namespace spidar
