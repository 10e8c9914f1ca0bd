// What boards keep in their flash: read, changed only as it was confirmed, read back.
#include <doctest/doctest.h>

#include "device/contract/device_claims.h"
#include "device/serial/board_flash.h"
#include "device/serial/serial_port.h"
#include "serial/serial_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

const std::atomic<bool> kNever{false};

std::vector<BoardFlash> read_flash(BoardBus &bus) {
    std::vector<BoardFlash> boards;
    std::string problem;
    const Status status = read_board_flash(bus.link(), kBoardBaud, kNever, boards, problem);
    REQUIRE_MESSAGE(usable(status), problem);
    return boards;
}

Status write(const FlashChange &change, BoardFlash &after, std::string &problem) {
    return write_board_flash(change, kBoardBaud, kNever, after, problem);
}

} // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE(
    "board flash: the factory's mask is read, set to all motors, and is there after a power-up") {
    BoardBus bus(one_b5m(), link_of_this_test());
    bus.with_boards([](auto &boards) { boards[0].quadrature_mask = 0; });
    const std::vector<BoardFlash> before = read_flash(bus);
    REQUIRE(before.size() == 1);
    CHECK(before[0].stored_id == 1);
    CHECK(before[0].quadrature_mask == 0);
    CHECK(bus.seen().flash_writes == 0);

    FlashChange change{bus.link(), before[0], BoardParameter::quadrature_mask, 0xFF};
    CHECK(validate(change, before) == "");
    CHECK(describe(change) == "quadrature mask 0x00 becomes 0xff");
    CHECK(exact_name(change) == "B5M with id 1 at " + bus.link());
    BoardFlash after;
    std::string problem;
    CHECK_MESSAGE(write(change, after, problem) == Status::ok, problem);
    CHECK(after.quadrature_mask == 0xFF);
    bus.restart_boards();
    CHECK(read_flash(bus)[0].quadrature_mask == 0xFF);
    CHECK(wait_for([&] { return bus.seen().flash_writes == 1; }, 100));

    // Twice is once: the board is no longer as it was read.
    CHECK(write(change, after, problem) == Status::invalid_settings);
    CHECK(problem.find("read the boards again") != std::string::npos);
    sleep_ms(5);
    CHECK(bus.seen().flash_writes == 1);
    CHECK(DeviceClaim::owner_of(serial_device_name(bus.link())).empty());
}

TEST_CASE("board flash: an id, whether it counts at once or after a power-up") {
    for (const bool at_once : {false, true}) {
        BoardBus bus(two_b3m(), link_of_this_test());
        bus.with_boards([&](auto &boards) { boards[1].id_counts_at_once = at_once; });
        const std::vector<BoardFlash> before = read_flash(bus);
        REQUIRE(before.size() == 2);
        BoardFlash after;
        std::string problem;
        FlashChange change{bus.link(), before[1], BoardParameter::board_id, 0};
        CHECK(validate(change, before).find("another board") != std::string::npos);
        CHECK(write(change, after, problem) == Status::invalid_settings);
        change.value = 5;
        CHECK_MESSAGE(write(change, after, problem) == Status::ok, problem);
        CHECK(after.stored_id == 5);
        CHECK(after.board.id == (at_once ? 5 : 1));
        bus.restart_boards();
        CHECK(read_flash(bus)[1].board.id == 5);
        CHECK(wait_for([&] { return bus.seen().flash_writes == 1; }, 100));
    }
}

TEST_CASE("board flash: what makes no sense, what is in use, and another board in its place") {
    BoardBus bus(one_b5m(), link_of_this_test());
    const std::vector<BoardFlash> before = read_flash(bus);
    FlashChange change{bus.link(), before[0], BoardParameter::quadrature_mask, 256};
    CHECK(validate(change, before).find("8 motors") != std::string::npos);
    change.value = 255;
    CHECK(validate(change, before).find("already holds this value") != std::string::npos);
    change.parameter = BoardParameter::pwm_period;
    CHECK(validate(change, before).find("only the board's id") != std::string::npos);
    change = {bus.link(), before[0], BoardParameter::board_id, 8};
    CHECK(validate(change, before).find("0 to 7") != std::string::npos);

    BoardFlash after;
    std::string problem;
    change.value = 3;
    {
        SerialTransport used(settings_for(bus.link())); // by whoever: the port is locked
        REQUIRE(usable(used.open()));
        CHECK(write(change, after, problem) == Status::device_in_use);
        DeviceClaim claim;
        REQUIRE(claim.take(serial_device_name(bus.link()), "a node"));
        CHECK(write(change, after, problem) == Status::device_in_use);
        CHECK(problem.find("\"a node\"") != std::string::npos);
    }
    change.board.board.info = kB3mInfo;
    CHECK(write(change, after, problem) == Status::invalid_settings);
    sleep_ms(5);
    CHECK(bus.seen().flash_writes == 0);
}

TEST_CASE("board flash: a board that does not keep what it was told is found out") {
    BoardBus bus(one_b5m(), link_of_this_test());
    const FlashChange change{bus.link(), read_flash(bus)[0], BoardParameter::quadrature_mask, 0x0F};
    bus.with_boards([](auto &boards) { boards[0].forgets = true; });
    BoardFlash after;
    std::string problem;
    CHECK(write(change, after, problem) == Status::protocol_mismatch);
    CHECK(after.quadrature_mask == 0xFF);
    CHECK(problem.find("holds 0xff and not the 0x0f") != std::string::npos);
}

TEST_SUITE_END();
