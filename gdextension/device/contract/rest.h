// What "at rest" means, once for all parts that evolve in time. A part is at rest when another cycle with the same reading
// and the same command would change none of its outputs, and of its state nothing but ages. While all parts are at rest a
// whole servo step may be skipped: its last answer is the answer, to the bit.
//
//     bool at_rest() const noexcept;                     every part with state
//     void advance_at_rest(double dt_s) noexcept;        a part with an age that counts: the age grows, nothing else
//     bool rests_through(double dt_s) const noexcept;    a part whose age comes to an end: not within this time
//
// Who owns parts holds them in one aggregate, whose with_all(combine) binds all of its members and calls combine(part...): a
// part that is added does not compile until it takes its share.
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

// Why parts are not at rest: bit i tells that part i, in the order of with_all(), is not.
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
