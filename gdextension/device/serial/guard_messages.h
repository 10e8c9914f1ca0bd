// Messages between host and guard, one byte each.
#pragma once

#include <cstdint>

namespace spidar::guard {

inline constexpr char kBeat = 'b';   // host: I am alive
inline constexpr char kQuit = 'q';   // host: set all currents to zero and end
inline constexpr char kAlive = 'a';  // guard: I am alive
inline constexpr char kZeroed = 'z'; // guard: the host was silent, currents are zero

// File descriptor of the serial port in the guard.
inline constexpr int kPort = 3;
// File descriptor of the socket to the host in the guard.
inline constexpr int kSocket = 4;

// Silence of the host after which currents are set to zero (unit: ms).
inline constexpr int kSilence_ms = 20;
// Interval of repeating the zero currents during silence (unit: ms).
inline constexpr int kRepeat_ms = 5;
// Number of zero commands before the guard ends.
inline constexpr int kLastTimes = 6;

} // namespace spidar::guard
