// Reports that are lost, late, repeated or overtaken, and clocks that differ: what the hand feels of them while it moves in
// contact, against the same motion with every report in time.
//
// A count is 25 um: where it falls changes the force by more than any of this (0.1 N at 350 N/m and 2 N s/m, 0.3 N at the
// caps, for a hand that is a third of a count elsewhere). So each disturbance is felt twice: with encoders a hundred times as
// fine, where the limits are those of the disturbance alone, and with the device's own, where the chatter of counts is added.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

namespace {

struct Wall {
    double stiffness_n_m = 350.0;
    double damping_n_s_m = 2.0;
    double most_n = 0.05; // what a disturbance may change of the force
};
constexpr Wall kUsual;
constexpr Wall kStiffest{2000.0, 5.0, 0.15};

// Swinging inside the wall, this fast where it is fastest: 4 mm to 20 mm deep.
struct Swing {
    double speed_m_s = 0.1;
    double shift_m = 0.0;
    [[nodiscard]] double y_m(double time_s) const {
        constexpr double kNearest_m = 0.004;
        constexpr double kHalfWay_m = 0.008;
        const double turn = speed_m_s / kHalfWay_m;
        return -kNearest_m - kHalfWay_m * (1.0 - std::cos(turn * std::max(time_s, 0.0))) + shift_m;
    }
};

// How the link treats a report: how late it comes in, whether at all, and whether once more a cycle later.
struct Fate {
    double late_s = 0.0;
    bool lost = false;
    bool twice = false;
};
struct Link {
    std::function<Fate(int report)> fate = [](int) { return Fate(); };
    double device_period_s = kTick_s; // by the host's clock; by its own it is kTick_s
    double phase = 0.0;               // of a period: how long before the cycle a report is made
    // What the device says of when it made a report (us).
    std::function<std::uint64_t(int report)> stamp_us = [](int report) {
        return static_cast<std::uint64_t>(report) * 1000;
    };
    std::function<double(int cycle)> host_late_s = [](int) { return 0.0; };
};

struct Felt {
    std::vector<double> time_s;
    std::vector<double> force_n;
    ServoCounters counters;
    [[nodiscard]] double at(double time) const { // a reference: one value a tick, from 0 on
        const double place =
            std::clamp(time / kTick_s, 0.0, static_cast<double>(time_s.size() - 2));
        const auto i = static_cast<std::size_t>(place);
        const double part = place - static_cast<double>(i);
        return (1.0 - part) * force_n[i] + part * force_n[i + 1];
    }
};

constexpr double kRun_s = 2.0;
// Until then forces rise, and the two clocks get acquainted.
constexpr double kSettled_s = 1.1;
constexpr double kFine = 100.0;

Felt feel(const Wall &wall, const Swing &swing, const Link &link, double fineness) {
    Bench bench;
    for (double &scale : bench.settings.strings.scale_m_per_count) {
        scale /= fineness;
    }
    bench.settings.safety.max_force_n = 100.0; // no limit is to hide anything
    bench.settings.safety.arming_time_s = 0.1;
    bench.settings.safety.workspace_margin_m = 0.0;
    bench.start();
    REQUIRE(bench.started == Status::ok);
    bench.command.forces_enabled = true;
    bench.command.contact_count = 1;
    bench.command.contacts[0].stiffness_n_m = wall.stiffness_n_m;
    bench.command.contacts[0].damping_n_s_m = wall.damping_n_s_m;

    struct Report {
        double due_s;
        int number;
    };
    std::vector<Report> on_the_way;
    int made = 0;
    int newest = 0;
    double last_s = 0.0;
    Felt felt;
    for (int cycle = 0; cycle * kTick_s < kRun_s; ++cycle) {
        const double now_s = (cycle + 1) * kTick_s + link.host_late_s(cycle);
        for (; (made + 1 - link.phase) * link.device_period_s <= now_s + 1e-9; ++made) {
            const Fate fate = link.fate(made + 1);
            const double due_s = (made + 1 - link.phase) * link.device_period_s + fate.late_s;
            if (!fate.lost) {
                on_the_way.push_back({due_s, made + 1});
            }
            if (fate.twice) {
                on_the_way.push_back({due_s + kTick_s, made + 1});
            }
        }
        int come = 0;
        bool repeated = false;
        int best = newest;
        std::erase_if(on_the_way, [&](const Report &report) {
            const bool here = report.due_s <= now_s + 1e-9;
            come += here && report.number > newest ? 1 : 0;
            repeated = repeated || (here && report.number <= newest);
            best = here ? std::max(best, report.number) : best;
            return here;
        });
        bench.read_status = come > 0 || repeated ? Status::ok : Status::read_timeout;
        if (bench.read_status == Status::ok) {
            const double made_s = (best - link.phase) * link.device_period_s;
            bench.put(test::moved_by(bench.settings, Vec3(0.0, swing.y_m(made_s - 0.2), 0.0)));
            bench.reading.sequence = static_cast<std::uint16_t>(best % 0xFFFF);
            bench.reading.device_time_us = link.stamp_us(best);
            bench.reading.overtaken = static_cast<std::uint16_t>(std::max(0, come - 1));
        }
        newest = best;
        ++bench.command.contacts_sequence;
        bench.tick(1, now_s - last_s);
        last_s = now_s;
        felt.time_s.push_back(now_s);
        felt.force_n.push_back(bench.now().requested.force_n.y);
    }
    felt.counters = bench.now().counters;
    REQUIRE(bench.now().state == DeviceState::active);
    return felt;
}

double worst_difference_n(const Felt &felt, const Felt &reference) {
    double worst_n = 0.0;
    double strongest_n = 0.0;
    for (std::size_t i = 0; i < felt.time_s.size(); ++i) {
        if (felt.time_s[i] < kSettled_s || felt.time_s[i] > kRun_s - 0.005) {
            continue;
        }
        // Cycle i of the reference is at (i + 1) ticks.
        const double expected_n = reference.at(felt.time_s[i] - kTick_s);
        worst_n = std::max(worst_n, std::abs(felt.force_n[i] - expected_n));
        strongest_n = std::max(strongest_n, std::abs(expected_n));
    }
    CHECK(strongest_n > 2.0); // it was in contact
    return worst_n;
}

// calm: the link without the disturbance.
void check_in_every_contact(const std::string &what, const std::function<Link()> &link_of,
                            const Link &calm = {}) {
    for (const Wall &wall : {kUsual, kStiffest}) {
        for (const double speed_m_s : {0.05, 0.1, 0.2}) {
            const Swing swing{speed_m_s};
            const Felt exact = feel(wall, swing, calm, kFine);
            const double alone_n = worst_difference_n(feel(wall, swing, link_of(), kFine), exact);
            const Felt counted = feel(wall, swing, calm, 1.0);
            const double as_counted_n =
                worst_difference_n(feel(wall, swing, link_of(), 1.0), counted);
            double chatter_n = 0.0;
            for (const double shift_m : {5e-6, 8e-6, 11e-6, 14e-6}) {
                const Felt shifted = feel(wall, Swing{speed_m_s, shift_m}, calm, 1.0);
                chatter_n = std::max(chatter_n, worst_difference_n(shifted, counted));
            }
            CAPTURE(what);
            CAPTURE(speed_m_s);
            CAPTURE(wall.stiffness_n_m);
            CAPTURE(chatter_n);
            CHECK(alone_n <= wall.most_n);
            CHECK(as_counted_n <= wall.most_n + chatter_n);
        }
    }
}

} // namespace

TEST_CASE("gaps: one and two lost reports are not felt") {
    for (const int in_a_row : {1, 2}) {
        check_in_every_contact("lost", [in_a_row] {
            Link link;
            link.fate = [in_a_row](int report) { return Fate{0.0, report % 37 < in_a_row, false}; };
            return link;
        });
    }
}

TEST_CASE("gaps: reports that come late, repeated or after their followers are not felt") {
    check_in_every_contact("late", [] {
        Link link;
        link.fate = [](int report) { return Fate{report % 41 == 0 ? 1.3e-3 : 0.0, false, false}; };
        return link;
    });
    check_in_every_contact("repeated", [] {
        Link link;
        link.fate = [](int report) { return Fate{0.0, false, report % 29 == 0}; };
        return link;
    });
    check_in_every_contact("swapped", [] {
        Link link;
        link.fate = [](int report) { return Fate{report % 31 == 0 ? 1.0e-3 : 0.0, false, false}; };
        return link;
    });
}

TEST_CASE("gaps: half a millisecond of jitter of the link, or of the host, is not felt") {
    Link halfway;
    halfway.phase = 0.5;
    halfway.fate = [](int) { return Fate{0.5e-3, false, false}; };
    const auto jittered = [] {
        Link link;
        link.phase = 0.5;
        auto dice = std::make_shared<std::mt19937>(5);
        link.fate = [dice](int) {
            return Fate{std::uniform_real_distribution<double>(0.0, 1e-3)(*dice), false, false};
        };
        return link;
    };
    check_in_every_contact("jitter of the link", jittered, halfway);
    check_in_every_contact("jitter of the host", [] {
        Link link;
        auto dice = std::make_shared<std::mt19937>(6);
        link.host_late_s = [dice](int) {
            return std::uniform_real_distribution<double>(0.0, 0.9e-3)(*dice);
        };
        return link;
    });
}

TEST_CASE("gaps: a device whose clock is half a percent off ours is not felt") {
    for (const double off : {-0.005, 0.005}) {
        check_in_every_contact(off < 0.0 ? "fast clock" : "slow clock", [off] {
            Link link;
            link.device_period_s = kTick_s * (1.0 + off);
            return link;
        });
    }
}

TEST_CASE("gaps: a clock of the device that stands, or runs at twice the rate, is not gone by") {
    for (const std::uint64_t rate : {0U, 2U}) {
        check_in_every_contact(rate == 0 ? "standing clock" : "mad clock", [rate] {
            Link link;
            link.stamp_us = [rate](int report) {
                return 7'000 + rate * 1'000 * static_cast<std::uint64_t>(report);
            };
            return link;
        });
    }
}

TEST_CASE("gaps: what was overtaken is not lost, and the numbers go round without a loss") {
    Link link;
    link.device_period_s = 0.5 * kTick_s; // two reports a cycle
    const Felt felt = feel(kUsual, Swing{0.05}, link, 1.0);
    CHECK(felt.counters.reports_missed == 0);
    Bench bench;
    bench.reading.sequence = 0xFFFC;
    bench.tick();
    const std::uint64_t before = bench.now().counters.reports_missed;
    for (const int number : {0xFFFD, 0xFFFE, 0, 1}) {
        bench.reading.sequence = static_cast<std::uint16_t>(number);
        bench.tick();
        CHECK(bench.now().counters.reports_missed == before);
    }
    bench.reading.sequence = 3; // a gap is one
    bench.tick();
    CHECK(bench.now().counters.reports_missed == before + 1);
    bench.reading.sequence = 6;
    bench.reading.overtaken = 2;
    bench.tick();
    CHECK(bench.now().counters.reports_missed == before + 1);
}
