#include <doctest/doctest.h>

#include "device/hid/protocol/report_sequence.h"
#include "device/hid/report_monitor.h"

using namespace spidar;
using Verdict = ReportMonitor::Verdict;

namespace {

struct Stream {
    ReportMonitor monitor;
    StateReport report;
    std::uint64_t host_us = 50'000'000;

    Verdict next(std::uint32_t steps = 1, std::uint32_t dt_us = 1000) {
        for (std::uint32_t i = 0; i < steps; ++i) {
            report.sequence = next_sequence(report.sequence);
        }
        report.device_time_us += steps * dt_us;
        host_us += std::uint64_t{steps} * dt_us;
        return check();
    }
    Verdict check() { return monitor.check(report, host_us); }
};

} // namespace

TEST_CASE("report monitor: gaps are counted, over the wraps of sequence and clock") {
    Stream stream;
    stream.report.sequence = 0xFFF0;
    stream.report.device_time_us = 0xFFFFFFFFU - 5000;
    REQUIRE(stream.check() == Verdict::fresh);
    for (int i = 0; i < 30; ++i) {
        REQUIRE(stream.next() == Verdict::fresh);
        REQUIRE(stream.monitor.lost() == 0);
    }
    CHECK(stream.monitor.device_time_us() == 0xFFFFFFFFULL - 5000 + 30000);
    CHECK(stream.next(5) == Verdict::fresh);
    CHECK(stream.monitor.lost() == 4);
}

TEST_CASE("report monitor: replayed, older and timeless reports are refused") {
    Stream stream;
    stream.next();
    stream.next();
    CHECK(stream.check() == Verdict::replayed);
    StateReport older = stream.report;
    older.sequence = static_cast<std::uint16_t>(older.sequence - 1);
    CHECK(stream.monitor.check(older, stream.host_us) == Verdict::out_of_order);
    StateReport still = stream.report;
    still.sequence = next_sequence(still.sequence);
    CHECK(stream.monitor.check(still, stream.host_us) == Verdict::implausible_time);
    still.device_time_us -= 10;
    CHECK(stream.monitor.check(still, stream.host_us) == Verdict::implausible_time);
    still.device_time_us += 10 + ReportMonitor::kLongestSilence_us + 1;
    CHECK(stream.monitor.check(still, stream.host_us) == Verdict::implausible_time);
    CHECK(stream.next() == Verdict::fresh); // none of them did harm
    CHECK(stream.monitor.lost() == 0);
}

TEST_CASE("report monitor: what waited in the queue of a stalled host is stale") {
    Stream stream;
    for (int i = 0; i < 100; ++i) {
        stream.next();
    }
    // 200 ms without reading; the queue kept the first 64 reports and lost the others.
    const std::uint64_t woken_us = stream.host_us + 200'000;
    for (int i = 1; i <= 64; ++i) {
        stream.report.sequence = next_sequence(stream.report.sequence);
        stream.report.device_time_us += 1000;
        CHECK(stream.monitor.check(stream.report, woken_us) == Verdict::stale);
    }
    stream.host_us += 64'000;
    CHECK(stream.next(137) == Verdict::fresh);
    CHECK(stream.monitor.lost() == 136);
}

TEST_CASE(
    "report monitor: a delay of less than 10 ms is no staleness, nor is drift of the clocks") {
    Stream stream;
    for (int i = 0; i < 100'000; ++i) {
        stream.host_us += i % 400 == 0 ? 1 : 0; // 2500 ppm
        const std::uint64_t late_us = i % 7 == 0 ? 9'000 : 0;
        stream.report.sequence = next_sequence(stream.report.sequence);
        stream.report.device_time_us += 1000;
        stream.host_us += 1000;
        REQUIRE(stream.monitor.check(stream.report, stream.host_us + late_us) == Verdict::fresh);
    }
}

TEST_CASE("report monitor: a device that began anew is taken up after 20 reports, as restarted") {
    Stream stream;
    for (int i = 0; i < 1000; ++i) {
        stream.next();
    }
    stream.report = StateReport();
    for (int i = 1; i < ReportMonitor::kResyncReports; ++i) {
        CHECK(stream.next() == Verdict::out_of_order);
    }
    CHECK(stream.next() == Verdict::restarted);
    CHECK(stream.next() == Verdict::fresh);
}

TEST_CASE("report monitor: clocks far apart are brought together, not refused for ever") {
    Stream stream;
    stream.next();
    stream.host_us += 5'000'000; // the host's clock leapt
    int stale = 0;
    while (stream.next() == Verdict::stale) {
        ++stale;
        REQUIRE(stale < 1000);
    }
    CHECK(stale == ReportMonitor::kStaleReports - 1);
    CHECK(stream.next() == Verdict::fresh);
}
