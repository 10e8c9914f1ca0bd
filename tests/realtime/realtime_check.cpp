// A servo loop in real time, recorded, with contacts, wrenches, faults and their clearing, built with -fsanitize=realtime:
// the sanitizer ends the program at the first allocation, lock or waiting call inside a cycle.
// realtime_check --provoke does allocate in such a function, and must not come to its end.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "device/loop/servo_loop.h"
#include "device/simulation/simulated_transport.h"
#include "device/threads/nonblocking.h"

using namespace spidar;

namespace {

constexpr int kFrames = 180; // three seconds of a game
constexpr std::chrono::milliseconds kFrame{16};

std::unique_ptr<int> kept; // outside, so that the compiler cannot do without the allocation

void allocate() noexcept SPIDAR_NONBLOCKING {
    kept = std::make_unique<int>(7);
}

// Empty: forces were on, faults came, cycles were recorded.
std::string run(const std::string &path) {
    auto made = std::make_unique<SimulatedTransport>(PlantSettings{});
    SimulatedTransport &device = *made;
    ServoSettings settings;
    settings.safety.arming_time_s = 0.1;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          made->home_counts(), kPaperMetresPerCount);
    ServoLoop loop(std::move(made));
    if (!usable(loop.start_threaded(settings))) {
        return "the loop does not start";
    }
    HapticCommand command;
    command.forces_enabled = true;
    ServoSnapshot now;
    int active = 0;
    int stopped = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame == 30) {
            const std::string problem = loop.start_recording(path);
            if (!problem.empty()) {
                return problem;
            }
        }
        command.contact_count = 1 + frame % kMaxContacts;
        for (int i = 0; i < command.contact_count; ++i) {
            command.contacts[static_cast<std::size_t>(i)].id = i;
            command.contacts[static_cast<std::size_t>(i)].offset_m = 0.01 - 0.002 * i;
            command.contacts[static_cast<std::size_t>(i)].friction = 0.3;
        }
        ++command.contacts_sequence;
        command.wrench.force_n.x = 0.1 * (frame % 9);
        command.wrench_duration_s = 0.05;
        ++command.wrench_sequence;
        HandTarget target;
        target.position_m = Vec3(0.0, frame % 30 < 15 ? -0.03 : 0.02, 0.0);
        device.set_hand_target(target);
        if (frame == 60) {
            device.inject({SimulatedFault::count_jump, 3, 0.0, 0.05});
        }
        if (frame == 100) {
            device.inject({SimulatedFault::unplugged, 0, 0.0, 0.05});
        }
        if (frame == 80 || frame == 130) {
            ++command.clear_fault_count;
            ++command.arm_count;
        }
        loop.publish(command);
        std::this_thread::sleep_for(kFrame);
        loop.latest(now);
        active += now.state == DeviceState::active ? 1 : 0;
        stopped += now.state == DeviceState::fault || now.state == DeviceState::closed ? 1 : 0;
    }
    loop.stop();
    if (active == 0 || stopped == 0 || loop.recording_statistics().cycles == 0) {
        return "no forces, no faults or no recording";
    }
    return {};
}

} // namespace

int main(int argc, char **argv) {
    if (argc == 2 && std::strcmp(argv[1], "--provoke") == 0) {
        allocate();
        std::printf("nobody stopped the allocation\n");
        return 0;
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    const std::string path = (std::filesystem::temp_directory_path() /
                              ("spidar_realtime_" + std::to_string(now) + ".rec"))
                                 .string();
    const std::string problem = run(path);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    if (!problem.empty()) {
        std::printf("FAILED: %s\n", problem.c_str());
    }
    std::printf("%d passed, %d failed\n", problem.empty() ? 1 : 0, problem.empty() ? 0 : 1);
    return problem.empty() ? 0 : 1;
}
