#include "device/contract/device_event.h"

#include <limits>

namespace spidar {

namespace {

constexpr auto kInfo = EventLevel::info;
constexpr auto kWarning = EventLevel::warning;
constexpr auto kFault = EventLevel::fault;

// In the order of the enumeration.
constexpr std::array<EventDescription, kDeviceEventKinds> kDescriptions{{
    {"device_connected", "link", kInfo, "", "The device is open and its grip is being read.", ""},
    {"device_lost", "link", kFault, "", "The device no longer responds and was closed.",
     "Check the cable, then call clear_fault(), zero_at_home() and arm()."},
    {"open_failed", "link", kFault, "", "The device could not be opened.",
     "Check the cable and the access rights; the add-on tries again every second."},
    {"armed", "state", kInfo, "", "Forces are rendered in full.", ""},
    {"disarmed", "state", kInfo, "", "Forces are no longer rendered.", ""},
    {"reports_late", "link", kWarning, "s", "No report arrived in time; the wrench fades.",
     "Check the cable and the other devices on the same bus."},
    {"reports_stopped", "link", kFault, "s", "No report arrived for too long; the motors are off.",
     "Check the cable, then call clear_fault() and arm()."},
    {"reports_missed", "link", kWarning, "reports", "Reports from the device were lost.",
     "Check the cable and the other devices on the same bus."},
    {"report_out_of_order", "link", kWarning, "", "An old report arrived again and was ignored.",
     "Check the cable and the device's firmware."},
    {"device_restarted", "link", kFault, "",
     "The device's clock restarted, so its counts have lost their zero; the motors are off.",
     "Hold the grip at home, call clear_fault() and zero_at_home()."},
    {"write_blocked", "link", kWarning, "s", "The device does not accept the tension commands.",
     "Check the cable; unplug the device if this continues."},
    {"sample_refused", "string", kWarning, "", "One impossible sample was ignored.",
     "If this repeats, check the encoder's cable."},
    {"count_jump", "string", kFault, "", "An encoder count jumped; the motors are off.",
     "Check the encoder's cable, zero the device, then call clear_fault() and arm()."},
    {"pose_lost", "string", kFault, "", "No pose fits the string lengths; the motors are off.",
     "Check the strings and the calibration, then call clear_fault() and arm()."},
    {"string_suspected", "string", kWarning, "m",
     "The string lengths began to contradict each other; the wrench fades.",
     "Look for a slack or caught string."},
    {"string_fault", "string", kFault, "m",
     "The string lengths contradict each other; the motors are off.",
     "Look for a broken, slack or caught string, then zero the device again."},
    {"string_named", "string", kWarning, "m",
     "The measured length of this string contradicts the others.",
     "Check this string, then zero the device again."},
    {"fast_grip", "motion", kWarning, "m/s",
     "The grip moves fast; the wrench fades until the grip slows down.", ""},
    {"over_speed", "motion", kFault, "m/s",
     "The grip went faster than the limit; the motors are off.",
     "Hold the grip, then call clear_fault() and arm()."},
    {"workspace_edge", "motion", kInfo, "m", "The grip is at the edge of its workspace.",
     "Move the grip toward the center."},
    {"motors_warm", "heat", kWarning, "", "A motor is warm; forces are reduced.",
     "Request less force, or wait."},
    {"overheated", "heat", kFault, "", "A motor's thermal budget is spent; forces fade.",
     "Let the motor cool for half a minute, then call arm()."},
    {"shaking", "motion", kWarning, "m/s", "The forces shake the grip and are halved.",
     "Lower the stiffness or the damping."},
    {"unstable", "motion", kFault, "m/s", "The forces still shake the grip; the motors are off.",
     "Lower the stiffness or the damping, then call clear_fault() and arm()."},
    {"request_refused", "request", kWarning, "",
     "A request was malformed or not finite and was ignored.",
     "Check the numbers that the game sends."},
    {"request_limited", "request", kInfo, "", "A request exceeded a limit and was clamped.",
     "Request less, or raise the limit."},
    {"game_stalled", "game", kWarning, "s", "The game stopped responding; forces fade.",
     "Call arm() when the game runs again (a simulated device arms itself)."},
    {"panic_stopped", "game", kFault, "", "Panic stop: the motors are off.",
     "Call clear_fault() and arm()."},
    {"cycles_late", "timing", kWarning, "s", "Servo cycles ran late.",
     "Close other programs, or lower rate_hz."},
    {"loop_stalled", "timing", kFault, "s", "The servo thread stopped running; the motors are off.",
     "Check the device, then call clear_fault() and arm()."},
    {"clock_jumped", "timing", kWarning, "s", "The computer slept or its clock jumped.",
     "Call arm()."},
    {"no_real_time_priority", "timing", kInfo, "",
     "The system grants no real-time priority; cycles may come late when it is busy.",
     "On Linux, allow it with the line \"@users - rtprio 50\" in /etc/security/limits.conf."},
    {"zero_needed", "calibration", kWarning, "", "The device has no zero.",
     "Hold the grip at home and call zero_at_home()."},
    {"zero_taken", "calibration", kInfo, "", "The zero is set; it is checked while the grip moves.",
     "Move and turn the grip by a few centimeters."},
    {"zero_confirmed", "calibration", kInfo, "m", "The zero agrees with the motion.", ""},
    {"zero_refused", "calibration", kWarning, "m", "The zero does not agree with the motion.",
     "Check the strings' order and direction, hold the grip at home and call zero_at_home()."},
    {"no_hand", "state", kInfo, "", "No hand was detected, so the device did not arm.",
     "Move the grip a little, then call arm()."},
    {"impossible_tension", "state", kWarning, "",
     "The safety gate received a tension that no valid request produces.",
     "This is a defect of the add-on; please report it."},
    {"device_stopped", "link", kFault, "",
     "The device switched its own motors off because of an emergency stop, the watchdog, the power "
     "supply, an encoder or heat.",
     "get_fault_text() names the cause; remove it, then call clear_fault() and arm()."},
}};

constexpr EventDescription kUnknown{
    "unknown", "state", kWarning, "", "An event of a newer version.", ""};

} // namespace

const EventDescription &describe(DeviceEventKind kind) noexcept {
    const auto index = static_cast<std::size_t>(kind);
    return index < kDescriptions.size() ? kDescriptions[index] : kUnknown;
}

void EventLog::begin_cycle(double time_s) noexcept {
    now_s_ = time_s;
    count_ = 0;
    silent_ = true;
}

void EventLog::tell(DeviceEventKind kind, int string, double value) noexcept {
    const auto index = static_cast<std::size_t>(kind);
    if (index >= memory_.size()) {
        return;
    }
    silent_ = false;
    Memory &memory = memory_[index];
    // Faults are latched: each is reported at once.
    const bool quiet = memory.told && now_s_ - memory.told_s < kQuiet_s &&
                       describe(kind).level != EventLevel::fault;
    if (quiet || count_ >= events_.size()) {
        memory.left_out = memory.left_out < std::numeric_limits<std::uint16_t>::max()
                              ? static_cast<std::uint16_t>(memory.left_out + 1)
                              : memory.left_out;
        return;
    }
    events_[count_] = {now_s_, value, kind, static_cast<std::int8_t>(string), memory.left_out};
    ++count_;
    memory = {now_s_, 0, true};
}

} // namespace spidar
