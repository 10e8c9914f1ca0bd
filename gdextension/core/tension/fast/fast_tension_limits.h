// Sizes and tolerances of the fast tension path, the same for every vector type.
#pragma once

#include <cstddef>

namespace spidar {

inline constexpr std::size_t kFastStrings = 8;
inline constexpr std::size_t kFastDofs = 7;

// Pivots of the table that are a smaller share of the mean diagonal of H (its square for pairs) have lost more digits
// than the corrections can make good: they would contract too slowly to tell convergence from standstill.
inline constexpr double kCancelled = 1e-10;
inline constexpr double kLargest = 1e12;
// Trace of H over its smallest eigenvalue, at most: beyond, doubles do not tell H from a singular matrix.
inline constexpr double kWorstCondition = 1e15;

// A correction shorter than this ends them. Longer ones do when the contraction seen, correction over first step,
// leaves less than kLeft_n for the next.
inline constexpr double kStep_n = 1e-13;
inline constexpr double kLeft_n = 1e-14;
inline constexpr double kShort_n = 1e-8; // not longer than this, whatever the contraction
inline constexpr int kCorrections = 4;
// Rounding of the gradient as a share of the largest force that cancels in it, and how far it may move a string.
inline constexpr double kNoise = 2e-15;
inline constexpr double kNoiseMove_n = 4e-12;
// Pivots on a table inverted with condition c (trace of H times its softest element) leave elements that may be c times
// smaller than what they are the difference of, which had lost c already: corrections with it contract by
// kTableRounding c^2 at worst. Beyond kWorstContraction they may stand still, which looks like convergence: the
// table is then inverted afresh on the strings that the pivots left free.
inline constexpr double kTableRounding = 1e-16;
inline constexpr double kWorstContraction = 1e-2;
// What the table (about 1e-9 N at w = 1e-6) cannot tell from zero.
inline constexpr double kTableTolerance = 1e-9;
// Passes over all violated strings; then one at a time, the last first (Murty), which cannot cycle.
inline constexpr int kBlockPasses = 4;
inline constexpr int kPasses = 24;
inline constexpr int kTables = 4; // inversions; a warm start seldom needs a second
inline constexpr double kOpen = 1e300;
inline constexpr double kLargestForce_n = 1e150; // its square is still finite

} // namespace spidar
