// Sizes and tolerances of the fast solver, equal for all vector types.
#pragma once

#include <cstddef>

namespace spidar {

inline constexpr std::size_t kFastStrings = 8;
inline constexpr std::size_t kFastDofs = 7;

// Smallest usable pivot relative to the mean diagonal of H (its square for pairs). Smaller pivots
// have lost so many digits that corrections contract too slowly to tell convergence from
// standstill.
inline constexpr double kCancelled = 1e-10;
// Largest input that is accepted (unit: N).
inline constexpr double kLargest = 1e12;
// Largest ratio of H's trace to its smallest eigenvalue. Beyond it doubles cannot tell H from a
// singular matrix.
inline constexpr double kWorstCondition = 1e15;

// After a correction below this no further correction is needed (unit: N).
inline constexpr double kStep_n = 1e-13;
// A correction below kShort_n is also the last one if the next, at the rate at which corrections
// shrink, would be below this (unit: N).
inline constexpr double kLeft_n = 1e-14;
// Largest correction from which the size of the next one is predicted (unit: N).
inline constexpr double kShort_n = 1e-8;
// Corrections after which the exact solver takes over.
inline constexpr int kCorrections = 4;
// Rounding of the gradient as a share of the largest force that cancels in it.
inline constexpr double kNoise = 2e-15;
// Largest motion of a string by that rounding in a certified answer (unit: N).
inline constexpr double kNoiseMove_n = 4e-12;
// A table inverted with condition c (trace of H times its largest diagonal element) has lost a
// factor c, and pivots on it may lose another: corrections contract by kTableRounding c^2 at worst.
inline constexpr double kTableRounding = 1e-16;
// Largest contraction, the ratio of a correction to the one before, that is accepted. Beyond it
// corrections may stand still, which looks like convergence; the table is then inverted again for
// the strings that the pivots left free.
inline constexpr double kWorstContraction = 1e-2;
// Rounding of the table (unit: N; about 1e-9 at w = 1e-6): smaller violations count as zero.
inline constexpr double kTableTolerance = 1e-9;
// Passes that pivot all violated strings. Later passes pivot one string, the last first (Murty),
// which cannot cycle.
inline constexpr int kBlockPasses = 4;
inline constexpr int kPasses = 24;
// Largest number of inversions; a warm start seldom needs a second.
inline constexpr int kTables = 4;
inline constexpr double kOpen = 1e300;
inline constexpr double kLargestForce_n = 1e150; // its square is still finite

} // namespace spidar
