// Strings, boards and motors: the table between them, and what a current is to a board.
#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "device/serial/motor_table.h"

using namespace spidar;

namespace {

constexpr BoardLayout kFirst{2, {5, 3, 4, 4, 0, 0}, 0};
constexpr BoardLayout kSecond{6, {5, 3, 4, 4, 0, 0}, 0};
constexpr BoardLayout kBoth[] = {kFirst, kSecond};

} // namespace

TEST_CASE("serial motors: in order, they go through the boards") {
    const SerialMotorTable table = motors_in_order(kBoth, {});
    CHECK(table[0].board_id == 2);
    CHECK(table[3].motor == 3);
    CHECK(table[4].board_id == 6);
    CHECK(table[4].motor == 0);
    CHECK(validate(table, kBoth).empty());
    const auto places = boards_of(table, kBoth);
    CHECK(places[3] == 0);
    CHECK(places[7] == 1);
    const BoardLayout one[] = {kFirst};
    CHECK(validate(motors_in_order(one, {}), one).find("The boards on the bus have 4 motors") == 0);
}

TEST_CASE("serial motors: a table that cannot be is told") {
    SerialMotorTable table = motors_in_order(kBoth, {});
    table[5].motor = 4;
    CHECK(validate(table, kBoth).find("String 6: board 6, motor 4 is not on the bus") == 0);
    table[5].motor = -1;
    CHECK(!validate(table, kBoth).empty());
    table[5] = table[1];
    CHECK(validate(table, kBoth).find("pulls string 2 already") != std::string::npos);
    table = motors_in_order(kBoth, {});
    table[7].current_sign = 0;
    CHECK(validate(table, kBoth).find("signs") != std::string::npos);
}

TEST_CASE("serial motors: no current is more than the limit, none pushes, and NaN is none") {
    CHECK(board_units(0.5, 618.0, 1024, 1) == 309);
    CHECK(board_units(0.5, 618.0, 1024, -1) == -309);
    CHECK(board_units(5.0, 618.0, 1024, -1) == -1024);
    CHECK(board_units(-1.0, 618.0, 1024, 1) == 0);
    CHECK(board_units(std::numeric_limits<double>::infinity(), 618.0, 1024, 1) == 1024);
    CHECK(board_units(std::numeric_limits<double>::quiet_NaN(), 618.0, 1024, 1) == 0);
}

TEST_CASE("serial motors: each board's command holds its motors' currents") {
    SerialMotorTable table = motors_in_order(kBoth, {});
    std::swap(table[0], table[7]);
    BoardFrame frame;
    append_currents(frame, kBoth, table, {1, 2, 3, 4, 5, 6, 7, 8}, 1.0, 1000);
    REQUIRE(frame.whole());
    const auto bytes = frame.bytes();
    REQUIRE(bytes.size() == 74);
    CHECK(bytes[0] == 0x32);
    CHECK(bytes[1] == 8);
    CHECK(bytes[3] == 2);
    CHECK(bytes[37] == 0x36);
    CHECK(bytes[44] == 1);
}
