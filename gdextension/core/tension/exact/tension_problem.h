// One bounded least-squares problem for the tensions, and the exact solver. tension_solver.h builds
// the problem from settings and the last tick.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"

namespace spidar {

//   min ||W (A tau - q)||^2 + proximal_weight ||tau - proximal_target||^2
//       subject to lower <= tau <= upper
struct TensionProblem {
    WrenchMatrix matrix;
    PaperWrench wrench{};   // q, in the paper's order and with g
    PaperWeights weights{}; // diagonal of W
    // Weight of all quadratic terms in tau alone, combined into one weight and one target per
    // string. A weight > 0 makes the optimum unique.
    double proximal_weight = 0.0;
    StringArray proximal_target_n{};
    StringArray lower_n{};
    StringArray upper_n{};
};

enum class StringBound : std::uint8_t { free = 0, at_lower = 1, at_upper = 2 };
using ActiveSet = std::array<StringBound, kStringCount>;

// Checks restored memory: see core/base/sound_state.h.
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
    int iterations = 0;           // of the solver that found the answer
    Status status = Status::ok;
};

// Returns the exact optimum of `problem`, also with zero weights, lost rank or zero multipliers.
// warm (may be null): a guess of the active set, which changes only the time. Status not_finite for
// input that is not finite, invalid_settings for a proximal weight that is not positive or a lower
// bound above the upper one: the tensions are then the lower bounds, clamped to [0, upper], and
// never NaN.
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

// Returns the strings held at `bound`, which must be at_lower or at_upper. The bit of `bound` is
// taken from each byte of the set; the product gathers the lowest bits of all eight bytes in its
// top byte.
[[nodiscard]] inline StringMask strings_at(const ActiveSet &active, StringBound bound) noexcept {
    constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;
    constexpr std::uint64_t kGather = 0x0102040810204080ULL;
    const unsigned bit = bound == StringBound::at_upper ? 1U : 0U;
    const auto bytes = std::bit_cast<std::uint64_t>(active);
    return static_cast<StringMask>((((bytes >> bit) & kLowBits) * kGather) >> 56U);
}

// Returns the active set for two masks: of strings at their lower and at their upper bound. Bits
// above the eighth are ignored.
[[nodiscard]] inline ActiveSet active_set(unsigned at_lower, unsigned at_upper) noexcept {
    // Moves bit k to the lowest bit of byte k: of eight copies each byte keeps its own bit, which
    // carries into its top bit.
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
