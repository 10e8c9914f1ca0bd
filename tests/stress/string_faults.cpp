// string_faults --cases N --seed S [--healthy_s T]: N motions of 5 s, T1-like, each with a random
// fault of one string (slipped or slack by 5 to 25 mm, stuck, swapped, reversed); then T seconds of
// healthy motion (default 5 N) of devices calibrated within 0.1 mm. Prints, for each fault, how often the right string and the right
// fault were named, and each miss so that it replays alone (--first CASE --cases 1). Exit code 1
// when the right string is named in less than 99 % of the cases, or healthy devices are accused once an hour or more often.
// Named without stress_: a case is 5,000 servo ticks, not one.
#include <cstdio>

#include "support/command_line.h"
#include "support/fault_motion.h"

namespace {

using namespace spidar;
using namespace spidar::test;

constexpr double kMotion_s = 5.0;
constexpr StringFault kFaults[] = {StringFault::slipped, StringFault::slack, StringFault::stuck,
                                   StringFault::swapped, StringFault::reversed};
constexpr long kFaultCount = 5;
constexpr double kBar = 0.99;
constexpr double kAlarmsAnHour = 1.0; // fewer than this
// A healthy device is calibrated as the self-calibration leaves it with 100 poses, and a little worse.
constexpr double kCalibrationError_m = 1e-4;

// Motions one after the other; every accusation counts, and ends its motion.
long false_alarms(std::uint64_t seed, double healthy_s) {
    constexpr double kStretch_s = 60.0;
    long alarms = 0;
    long part = 0;
    for (double done = 0.0; done < healthy_s; done += kStretch_s, ++part) {
        Draw draw(seed * 7919U + static_cast<std::uint64_t>(part));
        FaultyDevice device(FaultCase{}, draw, kCalibrationError_m);
        const int ticks = static_cast<int>(std::fmin(kStretch_s, healthy_s - done) / kTick_s);
        for (int k = 0; k < ticks; ++k) {
            if (device.step(k * kTick_s).fault != StringFault::none) {
                std::printf("false alarm: seed %lu, part %ld, %.3f s\n",
                            static_cast<unsigned long>(seed), part, k * kTick_s);
                ++alarms;
                break;
            }
        }
    }
    return alarms;
}

} // namespace

int main(int argc, char **argv) {
    const auto cases = static_cast<long>(test::number_option(argc, argv, "--cases", 100));
    const auto first = static_cast<long>(test::number_option(argc, argv, "--first", 0));
    const auto seed = static_cast<std::uint64_t>(test::number_option(argc, argv, "--seed", 1));
    const double healthy_s =
        test::number_option(argc, argv, "--healthy_s", kMotion_s * static_cast<double>(cases));
    if (cases <= 0 || first < 0 || !(healthy_s >= 0.0)) {
        std::fprintf(stderr, "--cases is %ld, --first %ld; give positive numbers.\n", cases, first);
        return 2;
    }
    long tried[kFaultCount] = {};
    long string_right[kFaultCount] = {};
    long fault_right[kFaultCount] = {};
    long right = 0;
    for (long k = first; k < first + cases; ++k) {
        Draw draw(seed * 1000003U + static_cast<std::uint64_t>(k));
        const long kind = k % kFaultCount;
        const FaultCase fault = random_fault(draw, kFaults[kind]);
        const FaultEvidence found = evidence_after(fault, draw, kMotion_s);
        const bool hit = right_string(fault, found);
        ++tried[kind];
        string_right[kind] += hit ? 1 : 0;
        fault_right[kind] += hit && found.fault == fault.fault ? 1 : 0;
        right += hit ? 1 : 0;
        if (!hit) {
            std::printf(
                "miss: case %ld, %s string %d/%d by %.2f mm from %.3f s: said %s %d/%d, misfit "
                "%.2f next %.2f, parity %.2f mm\n",
                k, describe(fault.fault), fault.string, fault.other, fault.size_m * 1e3,
                fault.onset_s, describe(found.fault), found.string, found.other, found.misfit,
                found.next_misfit, found.parity_rms_m * 1e3);
        }
    }
    for (long kind = 0; kind < kFaultCount; ++kind) {
        if (tried[kind] > 0) {
            std::printf("%-9s cases %ld, right string %ld, right fault too %ld\n",
                        describe(kFaults[kind]), tried[kind], string_right[kind],
                        fault_right[kind]);
        }
    }
    const long alarms = false_alarms(seed, healthy_s);
    const double share = static_cast<double>(right) / static_cast<double>(cases);
    std::printf("seed %lu, cases %ld, right string %.2f %%; %ld false alarms in %.2f h of motion\n",
                static_cast<unsigned long>(seed), cases, 100.0 * share, alarms, healthy_s / 3600.0);
    const bool quiet =
        alarms == 0 || static_cast<double>(alarms) * 3600.0 < kAlarmsAnHour * healthy_s;
    return share >= kBar && quiet ? 0 : 1;
}
