// One bounded least-squares problem of the tensions, spelled out, and what solves it: tension_solver.h poses it from
// settings and the last tick.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"

namespace spidar {

//   min ||W (A tau - q)||^2 + proximal_weight ||tau - proximal_target||^2    subject to lower <= tau <= upper
struct TensionProblem {
    WrenchMatrix matrix;
    PaperWrench wrench{};   // q, the paper's order and g
    PaperWeights weights{}; // diagonal of W
    // Sum of all quadratic terms in tau alone, as one weight and one target per string:
    // proximal_weight * (tau_i - proximal_target_i)^2. Weight > 0 makes the optimum unique.
    double proximal_weight = 0.0;
    StringArray proximal_target_n{};
    StringArray lower_n{};
    StringArray upper_n{};
};

enum class StringBound : std::uint8_t { free = 0, at_lower = 1, at_upper = 2 };
using ActiveSet = std::array<StringBound, kStringCount>;

// core/base/sound_state.h
[[nodiscard]] constexpr bool is_sound(const ActiveSet &active) noexcept {
    bool sound = true;
    for (const StringBound bound : active) {
        sound = sound && is_one_of(bound, StringBound::at_upper);
    }
    return sound;
}

struct TensionSolution {
    StringArray tensions_n{};
    ActiveSet active{};
    double largest_error_n = 0.0; // max |W (A tau - q)|
    int iterations = 0;           // factorisations
    Status status = Status::ok;
};

// Exact optimum of `problem`, by a search that serves any weights, lost rank and zero multipliers. `warm` (may be null) is
// a guess of the active set and changes only the time.
// Not finite input: status not_finite, tensions = lower bounds clamped to [0, upper]. Never NaN.
[[nodiscard]] TensionSolution solve_exactly(const TensionProblem &problem,
                                            const ActiveSet *warm) noexcept;

using StringMask = std::uint8_t; // bit i: string i

[[nodiscard]] constexpr bool has_string(StringMask mask, std::size_t string) noexcept {
    return ((static_cast<unsigned>(mask) >> string) & 1U) != 0U;
}
[[nodiscard]] constexpr StringMask with_string(StringMask mask, std::size_t string) noexcept {
    return static_cast<StringMask>(static_cast<unsigned>(mask) | (1U << string));
}
[[nodiscard]] constexpr StringMask without_string(StringMask mask, std::size_t string) noexcept {
    return static_cast<StringMask>(static_cast<unsigned>(mask) & ~(1U << string));
}

// The strings that are held at `bound`, at_lower or at_upper: its bit is looked for in each byte of the set, and the
// product gathers the lowest bits of all eight bytes in its top byte.
[[nodiscard]] inline StringMask strings_at(const ActiveSet &active, StringBound bound) noexcept {
    constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;
    constexpr std::uint64_t kGather = 0x0102040810204080ULL;
    const unsigned bit = bound == StringBound::at_upper ? 1U : 0U;
    const auto bytes = std::bit_cast<std::uint64_t>(active);
    return static_cast<StringMask>((((bytes >> bit) & kLowBits) * kGather) >> 56U);
}

// The set of strings held at their lower and at their upper bounds; bits above the eighth do not count.
[[nodiscard]] inline ActiveSet active_set(unsigned at_lower, unsigned at_upper) noexcept {
    // Bit k to the lowest bit of byte k: of eight copies each byte keeps its own bit, which carries into its top bit.
    const auto a_byte_a_string = [](unsigned mask) {
        constexpr std::uint64_t kCopies = 0x0101010101010101ULL;
        constexpr std::uint64_t kOwnBit = 0x8040201008040201ULL;
        constexpr std::uint64_t kAllButTop = 0x7F7F7F7F7F7F7F7FULL;
        const std::uint64_t own = ((mask & 0xFFU) * kCopies) & kOwnBit;
        return ((own + kAllButTop) >> 7U) & kCopies;
    };
    return std::bit_cast<ActiveSet>(a_byte_a_string(at_lower) | (a_byte_a_string(at_upper) << 1U));
}

} // namespace spidar
