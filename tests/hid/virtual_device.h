// What the two virtual devices of the VM test share: the firmware model, faults on its reports, and a log of what its
// motors did and when (on the machine's monotonic clock, which host and device share).
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "hid/firmware_model.h"

namespace spidar::test {

std::int64_t now_ns();

struct MotorSample {
    std::int64_t time_ns = 0;
    std::uint16_t strongest_mn = 0;
    std::uint16_t weakest_mn = 0;
};

// Counted by the device's thread.
struct DeviceObservations {
    std::uint64_t ticks = 0;
    std::uint64_t overruns = 0; // ticks that its own timer missed
    std::uint64_t reports = 0;  // sent
    std::uint64_t commands = 0; // received
    std::uint64_t commands_on_newest_state = 0;
    std::int64_t last_report_ns = 0;
    std::vector<MotorSample> motors; // each tick since clear()
};

// What happens to the next reports, each as many times as its number says.
struct ReportFaults {
    std::atomic<int> silent{0};    // not sent
    std::atomic<int> corrupted{0}; // a bit flipped
    std::atomic<int> shortened{0};
    std::atomic<int> replayed{0};  // the last one again, after the good one
    std::atomic<int> reordered{0}; // an older one again, after the good one
};

using ReportArray = std::array<std::uint8_t, kStateSize>;

class VirtualDevice {
public:
    explicit VirtualDevice(const FirmwareSettings &settings) : firmware_(settings) {}

    // Runs `work(FirmwareModel &)` between ticks.
    template <typename Work>
    auto with_firmware(const Work &work) {
        const std::lock_guard<std::mutex> lock(mutex_);
        return work(firmware_);
    }
    [[nodiscard]] DeviceObservations observations();
    void clear_observations();
    ReportFaults faults;

protected:
    // One tick of the device; the reports to send, in order.
    std::vector<std::vector<std::uint8_t>> tick(std::uint64_t expirations);
    void receive(ReportBytes bytes);

    std::mutex mutex_;
    FirmwareModel firmware_;
    DeviceObservations seen_;

private:
    // The grip rests at home until the device is zeroed; then a hand moves it up and down.
    void move_grip();

    FrameGeometry frame_ = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip_;
    int moving_ms_ = 0;
    ReportArray last_{};
    ReportArray older_{};
};

// A timer that fires every millisecond; -1 on failure.
int millisecond_timer();

} // namespace spidar::test
