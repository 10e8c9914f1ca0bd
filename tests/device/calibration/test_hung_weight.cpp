// Weighing with a weight that has mass: it is thrown up as it is lifted, and that must not count as friction.
#include <doctest/doctest.h>

#include "board_model/hung_weight.h"
#include "device/calibration/calibration_tasks.h"

using namespace spidar;

TEST_CASE("calibration tasks: the gain of a motor by a weight that swings past the height at which "
          "it is lifted") {
    constexpr double kGainLimit = 0.02;
    constexpr double kPeriod_s = 0.001;
    constexpr std::size_t kString = 2;
    for (const double weight_n : {1.0, 2.0, 4.0}) {
        for (const double gain : {0.9, 1.1}) {
            CalibrationTasks tasks;
            test::HungWeight weight;
            weight.hang(kString, weight_n);
            TaskInput input;
            input.device_ready = true;
            input.dt_s = kPeriod_s;
            const TaskOrder order{CalibrationTask::weighing, kString, weight_n, 1};
            for (int i = 0; i < 20'000; ++i) {
                input.lengths_m[kString] = 0.4 - weight.height_m();
                const StringArray tensions_n = tasks.step(order, input);
                weight.advance(gain * tensions_n[kString], kPeriod_s);
                if (tasks.result().verdict != TaskVerdict::running) {
                    break;
                }
            }
            REQUIRE(tasks.result().verdict == TaskVerdict::done);
            const double found = 2.0 * weight_n / (tasks.result().rise_n + tasks.result().fall_n);
            INFO("weight " << weight_n << " N, gain " << gain << ", found " << found);
            CHECK(std::fabs(found / gain - 1.0) <= kGainLimit);
        }
    }
}
