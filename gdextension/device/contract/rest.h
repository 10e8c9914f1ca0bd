// Defines "at rest" for all parts that evolve in time. A part is at rest when another cycle with
// the same reading and the same command would change no output, and of its state only ages (and the
// heat of the motors). While all parts are at rest a whole servo step may be skipped: the last
// answer holds, bit for bit.
//
//     bool at_rest() const noexcept;                     every part with state
//     void advance_at_rest(double dt_s) noexcept;        a part with an age: only adds to it
//     bool rests_through(double dt_s) const noexcept;    false if an age ends the rest within dt_s
//
// The owner of parts holds them in one aggregate, whose with_all(combine) binds all members and
// calls combine(part...). A part that is added without being bound does not compile.
#pragma once

#include <concepts>
#include <cstdint>

namespace spidar {

template <typename Part>
concept Rests = requires(const Part &part) {
    { part.at_rest() }
    noexcept->std::same_as<bool>;
};

template <typename Parts>
[[nodiscard]] bool all_at_rest(const Parts &parts) noexcept {
    return parts.with_all([](const Rests auto &...part) { return (part.at_rest() && ...); });
}

// Returns which parts are not at rest: bit i for part i, in the order of with_all().
template <typename Parts>
[[nodiscard]] std::uint32_t awake_mask(const Parts &parts) noexcept {
    return parts.with_all([](const Rests auto &...part) {
        std::uint32_t mask = 0;
        int bit = 0;
        ((mask |= (part.at_rest() ? 0U : 1U) << bit++), ...);
        return mask;
    });
}

} // namespace spidar
