#include <doctest/doctest.h>

#include <limits>

#include "support/fault_motion.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("string faults: each kind names its string") {
    // A short version of string_faults, which runs many.
    for (const StringFault fault : {StringFault::slipped, StringFault::stuck, StringFault::swapped,
                                    StringFault::reversed, StringFault::slack}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            Draw draw(seed * 31U);
            const FaultCase c = random_fault(draw, fault);
            const FaultEvidence found = evidence_after(c, draw, 5.0);
            CAPTURE(describe(fault));
            CAPTURE(seed);
            CHECK(found.string == c.string);
            CHECK(found.other == c.other);
            CHECK(found.fault == fault);
            if (fault == StringFault::slipped) {
                CHECK(found.error_m == doctest::Approx(c.size_m).epsilon(0.1));
            }
        }
    }
}

TEST_CASE("string faults: large errors that once threw a guess to where no pose exists") {
    // Cases of `string_faults --seed 2` that were missed: case, fault.
    struct Missed {
        std::uint64_t number;
        StringFault fault;
    };
    for (const Missed &missed :
         {Missed{20, StringFault::slipped}, Missed{250, StringFault::slipped},
          Missed{915, StringFault::slipped}, Missed{516, StringFault::slack}}) {
        Draw draw(2U * 1000003U + missed.number);
        const FaultCase c = random_fault(draw, missed.fault);
        CAPTURE(missed.number);
        CHECK(right_string(c, evidence_after(c, draw, 5.0)));
    }
}

TEST_CASE("string faults: after reset() an observer says what a fresh one says, tick for tick") {
    for (const StringFault before : {StringFault::slipped, StringFault::swapped}) {
        Draw draw(17);
        FaultyDevice suspicious(random_fault(draw, before), draw);
        for (int k = 0; k < 3000; ++k) {
            suspicious.step(k * kTick_s);
        }
        StringFaultObserver used = suspicious.observer();
        used.reset();
        // Another device's lengths, with a fault of its own: scores and suspects go through all they can.
        FaultyDevice device(random_fault(draw, StringFault::slack), draw);
        StringFaultObserver fresh = device.observer();
        fresh.reset();
        FaultyDevice other = device; // the same kinematics for both
        for (int k = 0; k < 4000; ++k) {
            const CountArray counts = device.counts_at_time(k * kTick_s);
            const FaultEvidence expected = device.step_with(fresh, counts);
            const FaultEvidence found = other.step_with(used, counts);
            REQUIRE(found.fault == expected.fault);
            REQUIRE(found.string == expected.string);
            REQUIRE(found.misfit == expected.misfit);
            REQUIRE(found.next_misfit == expected.next_misfit);
            REQUIRE(found.parity_rms_m == expected.parity_rms_m);
        }
    }
}

TEST_CASE("string faults: a healthy device is not accused") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Draw draw(seed);
        FaultyDevice device(FaultCase{}, draw);
        for (int k = 0; k < 20000; ++k) {
            const FaultEvidence found = device.step(k * kTick_s);
            REQUIRE(found.fault == StringFault::none);
        }
    }
}

TEST_CASE("string faults: a hand that holds still has no stuck string") {
    const DeviceModel device = paper_device();
    StringFaultObserver observer;
    REQUIRE(observer.configure(device.frame, device.grip, device.strings,
                               FaultObserverSettings{}) == Status::ok);
    ForwardKinematics kinematics;
    REQUIRE(usable(kinematics.configure(device.frame, device.grip)));
    const StringArray lengths = lengths_from_counts(device.strings, CountArray{});
    StringFault found = StringFault::none;
    for (int k = 0; k < 5000; ++k) {
        found = observer.update(CountArray{}, lengths, kinematics.update(lengths)).fault;
    }
    CHECK(found == StringFault::none);
}

TEST_CASE("string faults: bad input and bad settings change nothing") {
    const DeviceModel device = paper_device();
    StringFaultObserver observer;
    FaultObserverSettings settings;
    settings.parity_noise_m = 0.0;
    CHECK(observer.configure(device.frame, device.grip, device.strings, settings) ==
          Status::invalid_settings);
    CHECK(observer.configure(device.frame, device.grip, StringCalibration{},
                             FaultObserverSettings{}) == Status::invalid_calibration);
    CHECK(observer.configure(FrameGeometry{}, device.grip, device.strings,
                             FaultObserverSettings{}) == Status::invalid_geometry);
    REQUIRE(observer.configure(device.frame, device.grip, device.strings,
                               FaultObserverSettings{}) == Status::ok);
    StringArray lengths{};
    lengths.fill(std::numeric_limits<double>::quiet_NaN());
    const FaultEvidence &found = observer.update(CountArray{}, lengths, KinematicsResult{});
    CHECK(found.fault == StringFault::none);
    CHECK(found.parity_rms_m == 0.0);
}
