// A whole game in the virtual machine: Godot, the add-on as it ships, two SpidarG nodes (game/two_devices.gd), two devices.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>
#include <string>

#include <unistd.h>

#include "hid/uhid_device.h"
#include "hid/vm_host.h"

using namespace spidar;
using spidar::test::MotorTensions_mn;
using spidar::test::UhidDevice;

namespace {

// Godot and the game, put there by run_vm_tests.py.
constexpr const char *kGame = "/game/godot --headless --path /game/project -s two_devices.gd 2>&1";
constexpr int kLongestLine = 1000;
// The grip moves 5 mm up and down, the sum below is for the home pose.
constexpr double kForce_mn = 3000.0;
constexpr double kForceTolerance = 0.1;

// Of the eight motors: the sum of vertical pulls, up positive, were all strings at the home pose.
double pull_up_mn(const MotorTensions_mn &motors_mn) {
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    const GripGeometry grip;
    const GripPose home = rest_pose(grip);
    double up = 0.0;
    for (std::size_t i = 0; i < motors_mn.size(); ++i) {
        const Vec3 string = frame.motors_m[i] - attachment_point(grip, home, static_cast<int>(i));
        up += motors_mn[i] * string.y / glm::length(string);
    }
    return up;
}

} // namespace

TEST_CASE("vm: a Godot game with two SpidarG nodes on two devices") {
    REQUIRE_MESSAGE(access("/game/godot", X_OK) == 0, "run_vm_tests.py puts a Godot there");
    UhidDevice first({});
    test::UhidOptions options;
    options.serial = "VM-2";
    UhidDevice second(options);
    REQUIRE(first.plug());
    REQUIRE(second.plug());
    const auto motors = [](UhidDevice &device) {
        return device.with_firmware([](const test::FirmwareModel &f) { return f.motors_mn(); });
    };
    std::FILE *game = popen(kGame, "r");
    REQUIRE(game != nullptr);
    bool both = false;
    bool one_left = false;
    bool refused = false;
    char line[kLongestLine];
    std::string wrong;
    while (std::fgets(line, sizeof line, game) != nullptr) {
        std::fputs(line, stdout);
        std::fflush(stdout);
        if (std::strstr(line, "two devices: both pull") != nullptr) {
            both = true;
            CHECK(pull_up_mn(motors(first)) == doctest::Approx(kForce_mn).epsilon(kForceTolerance));
            CHECK(pull_up_mn(motors(second)) ==
                  doctest::Approx(-kForce_mn).epsilon(kForceTolerance));
        } else if (std::strstr(line, "two devices: one left") != nullptr) {
            one_left = true;
            CHECK(motors(first) == MotorTensions_mn{});
            CHECK(pull_up_mn(motors(second)) ==
                  doctest::Approx(-kForce_mn).epsilon(kForceTolerance));
        } else if (std::strstr(line, "(serial \"VM-1\") belongs to \"") != nullptr) {
            refused = true; // the third node, and why
        } else if (std::strncmp(line, "WRONG", 5) == 0 || std::strstr(line, "ERROR") != nullptr) {
            wrong += line;
        }
    }
    CHECK(pclose(game) == 0);
    CHECK(both);
    CHECK(refused);
    CHECK(one_left);
    CHECK(wrong.empty());
    test::sleep_ms(100.0);
    CHECK(motors(second) == MotorTensions_mn{});
}
