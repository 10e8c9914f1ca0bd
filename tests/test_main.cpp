// One program of all C++ unit tests: `spidar_tests -tc="*name*"` runs some of them.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
