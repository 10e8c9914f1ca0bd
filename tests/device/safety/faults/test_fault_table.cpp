// Every row of the fault table in docs/reference/safety.md is tested, and answered in time, with every hand.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "support/fault_table.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kMostEnergy_j = 0.050;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Ten times slower, and looking for other things: one hand passes every line.
constexpr HandFirmness kHands[] = {HandFirmness::light};
#else
constexpr HandFirmness kHands[] = {HandFirmness::light, HandFirmness::normal, HandFirmness::firm};
#endif

constexpr FaultRow kElsewhere[] = {
    {13, "malformed planes and poses", 0, 0, nullptr, "tests/device/step/test_servo_fuzz.cpp",
     "fuzz: 100000 commands: tensions finite and in [0, max], requests within limits"},
    {27, "cycles come late", 0, 0, nullptr, "tests/device/loop/test_servo_watchdogs.cpp",
     "watchdog: cycles that come late are counted, dropped and told"},
    {28, "servo thread stalled", 0, 0, nullptr, "tests/device/loop/test_servo_watchdogs.cpp",
     "watchdog: a servo thread that stands still: the writer thread switches the motors off"},
    {30, "device does not open", 0, 0, nullptr, "tests/device/loop/test_servo_watchdogs.cpp",
     "open: a device that does not open is tried again by the thread, and told once"},
    {31, "two nodes on one device", 0, 0, nullptr, "tests/godot/project/test_bad_input.gd",
     "test_second_node_on_one_device_is_refused"},
    {32, "node freed while active", 0, 0, nullptr, "tests/godot/project/test_lifecycle.gd",
     "test_random_lives_leave_no_thread"},
    {33, "project opened and closed", 0, 0, nullptr, "tests/godot/run_godot_tests.py",
     "project_opens_and_closes"},
    {34, "host killed or stopped", 0, 0, nullptr, "tests/device/loop/test_host_killed.cpp",
     "host killed or stopped: the firmware holds minimum tension at 20 ms and lets go at 50 ms"},
    {35, "bad calibration", 0, 0, nullptr, "tests/godot/project/test_bad_input.gd",
     "test_bad_calibration_is_refused_by_name"},
    {37, "torn state", 0, 0, nullptr, "tests/device/threads/test_triple_buffer.cpp",
     "triple buffer: two threads, a million writes, never torn, never older than before"},
};

std::string content(const std::string &path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<FaultRow> all_rows() {
    std::vector<FaultRow> rows;
    for (const auto part : {rows_of_game(), rows_of_link(), rows_of_strings(), rows_of_motion(),
                            std::span<const FaultRow>(kElsewhere)}) {
        rows.insert(rows.end(), part.begin(), part.end());
    }
    return rows;
}

} // namespace

TEST_CASE("fault table: every row of docs/reference/safety.md has a test, and every test a row") {
    std::set<int> documented;
    std::istringstream page(content("docs/reference/safety.md"));
    for (std::string line; std::getline(page, line);) {
        int number = 0;
        if (std::sscanf(line.c_str(), "| %d |", &number) == 1) {
            CHECK_MESSAGE(documented.insert(number).second, "row twice: " << number);
        }
    }
    CHECK(documented.size() == 38);
    std::set<int> tested;
    for (const FaultRow &row : all_rows()) {
        CAPTURE(row.number);
        CHECK(tested.insert(row.number).second);
        CHECK(documented.count(row.number) == 1);
        CHECK((row.run != nullptr) != (row.file != nullptr));
        if (row.file != nullptr) { // the other test exists
            CHECK_MESSAGE(content(row.file).find(row.test) != std::string::npos, row.file);
        }
    }
    CHECK(tested == documented);
}

TEST_CASE("fault table: each fault is answered in time, with bounded tension and energy") {
    for (const FaultRow &row : all_rows()) {
        if (row.run == nullptr) {
            continue;
        }
        for (const HandFirmness hand : kHands) {
            CAPTURE(row.number);
            CAPTURE(row.fault);
            CAPTURE(static_cast<int>(hand));
            const Answer answer = row.run(hand);
            MESSAGE("row " << row.number << ", hand " << static_cast<int>(hand) << ": "
                           << answer.response_ms << " ms, " << answer.tension_n << " N, "
                           << 1e3 * answer.energy_j << " mJ, " << answer.peak_speed_m_s << " m/s");
            CHECK(answer.response_ms >= 0.0); // answered at all
            CHECK(answer.response_ms <= row.limit_ms);
            CHECK(answer.tension_n <= TensionSettings{}.max_tension_n + 1e-9);
            if (row.released_limit_m_s > 0.0) {
                CHECK(answer.peak_speed_m_s <= row.released_limit_m_s);
            } else {
                CHECK(answer.energy_j <= kMostEnergy_j);
            }
        }
    }
}
