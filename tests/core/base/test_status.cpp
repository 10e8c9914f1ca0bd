#include <doctest/doctest.h>

#include <set>
#include <string>

#include "core/base/status.h"

using namespace spidar;

TEST_CASE("status: every named value has a sentence of its own") {
    std::set<std::string> seen;
    const std::string unknown = describe(static_cast<Status>(12345));
    int named = 0;
    for (int value = -60; value <= 20; ++value) {
        const char *text = describe(static_cast<Status>(value));
        REQUIRE(text != nullptr);
        if (text == unknown) {
            continue;
        }
        ++named;
        CAPTURE(value);
        CHECK(seen.insert(text).second);
        CHECK(std::string(text).back() == '.');
    }
    CHECK(named == 7 + 12 + 14 + 10); // usable, bad input, device, real device
}

TEST_CASE("status: the sign tells whether the result is usable") {
    CHECK(usable(Status::ok));
    CHECK(usable(Status::near_singular));
    CHECK_FALSE(usable(Status::not_finite));
    CHECK_FALSE(usable(Status::outside_frame));
}
