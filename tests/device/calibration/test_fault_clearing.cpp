// A device that stopped itself pulls again only after somebody asked for it.
#include <doctest/doctest.h>

#include "device/calibration/fault_clearing.h"

TEST_CASE("fault clearing: only for a task that finds the device not well, and not for ever") {
    spidar::FaultClearing clearing;
    CHECK(!clearing.step(0, false)); // nobody asked
    CHECK(!clearing.step(1, true));
    CHECK(!clearing.step(1, false)); // it stopped itself meanwhile
    CHECK(clearing.step(2, false));
    int cycles = 0;
    while (clearing.step(2, true) && cycles < 1000) {
        ++cycles;
    }
    CHECK(cycles > 10);
    CHECK(cycles < 100);
    CHECK(!clearing.step(2, false));
}
