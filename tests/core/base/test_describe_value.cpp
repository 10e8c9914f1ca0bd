#include <limits>

#include <doctest/doctest.h>

#include "core/base/describe_value.h"

using namespace spidar;

TEST_CASE("validate's sentences: field, value, unit, remedy") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(with_unit(0.04, "m") == "0.04 m");
    CHECK(with_unit(-nan, "m") == "nan m");
    CHECK(with_unit(1e-9, "") == "1e-09");
    CHECK(element_name("motors_m", 3) == "motors_m[3] (string 4)");
    CHECK(range_sentence("rate_hz", 5.0, "Hz", "give 100 or more.") ==
          "rate_hz is 5 Hz; give 100 or more.");
    CHECK(range_sentence("ridge", -1.0, "", "give 0 or more.") == "ridge is -1; give 0 or more.");
}

TEST_CASE("validate's sentences: a range holds both of its ends and no NaN") {
    const ValueRange low{"rate_hz", 100.0, "Hz", 100.0, 4000.0};
    const ValueRange high{"rate_hz", 4000.0, "Hz", 100.0, 4000.0};
    const ValueRange above{"rate_hz", 4001.0, "Hz", 100.0, 4000.0};
    const ValueRange nan{"latency_s", std::numeric_limits<double>::quiet_NaN(), "s", 0.0, 0.05};
    CHECK(range_sentence(low).empty());
    CHECK(range_sentence(high).empty());
    CHECK(range_sentence(above) == "rate_hz is 4001 Hz; set it between 100 and 4000 Hz.");
    CHECK(range_sentence(nan) == "latency_s is nan s; set it between 0 and 0.05 s.");
    const ValueRange ranges[] = {low, nan, above};
    CHECK(first_out_of_range(ranges) == range_sentence(nan));
    CHECK(first_out_of_range({ranges, 1}).empty());
}
