// What host and guard say to each other, one byte each.
#pragma once

#include <cstdint>

namespace spidar::guard {

inline constexpr char kBeat = 'b';   // host: I live
inline constexpr char kQuit = 'q';   // host: zero the currents and end
inline constexpr char kAlive = 'a';  // guard: so do I
inline constexpr char kZeroed = 'z'; // guard: you were silent, the currents are zero

// Where the guard finds what it inherits.
inline constexpr int kPort = 3;
inline constexpr int kSocket = 4;

inline constexpr int kSilence_ms = 20; // of the host, after which the currents are zeroed
inline constexpr int kRepeat_ms = 5;   // zeroed again while the silence lasts
inline constexpr int kLastTimes = 6;   // zeroed so often before the guard ends

} // namespace spidar::guard
