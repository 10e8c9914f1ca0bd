// Messages between the host (the process with the game) and the guard, one byte each.
#pragma once

#include <cstdint>

namespace spidar::guard {

inline constexpr char kBeat = 'b';   // host: I am alive
inline constexpr char kQuit = 'q';   // host: set all currents to zero and end
inline constexpr char kAlive = 'a';  // guard: I am alive
inline constexpr char kZeroed = 'z'; // guard: the host was silent, so I sent zero currents

// File descriptor of the serial port in the guard.
inline constexpr int kPort = 3;
// File descriptor of the socket to the host in the guard.
inline constexpr int kSocket = 4;

// Time since the host's last message after which the guard sends zero currents (unit: ms).
inline constexpr int kSilence_ms = 20;
// The guard repeats the zero currents at this interval while the host is silent (unit: ms).
inline constexpr int kRepeat_ms = 5;
// The guard sends zero currents this many times before it ends.
inline constexpr int kLastTimes = 6;

} // namespace spidar::guard
