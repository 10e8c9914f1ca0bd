// Marks a function that the servo thread runs between two deadlines: no allocation, lock, exception
// or waiting call. Clang 20 and later check it at run time with -fsanitize=realtime (./dev stage
// sanitize_realtime). Write it after the parameters: void f() noexcept SPIDAR_NONBLOCKING;
#pragma once

#if defined(__clang__) && defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define SPIDAR_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef SPIDAR_NONBLOCKING
#define SPIDAR_NONBLOCKING
#endif
