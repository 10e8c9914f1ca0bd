#include "device/contract/device_event.h"

#include <limits>

namespace spidar {

namespace {

constexpr auto kInfo = EventLevel::info;
constexpr auto kWarning = EventLevel::warning;
constexpr auto kFault = EventLevel::fault;

// In the order of the enumeration.
constexpr std::array<EventDescription, kDeviceEventKinds> kDescriptions{{
    {"device_connected", "link", kInfo, "", "The device is open and its grip is read.", ""},
    {"device_lost", "link", kFault, "", "The device no longer answers; it is closed.",
     "Check the cable, then call clear_fault(), zero_at_home() and arm()."},
    {"open_failed", "link", kFault, "", "The device could not be opened.",
     "Check the cable and the access rights; it is tried again every second."},
    {"armed", "state", kInfo, "", "Forces are rendered in full.", ""},
    {"disarmed", "state", kInfo, "", "Forces are no longer rendered.", ""},
    {"reports_late", "link", kWarning, "s", "No report came in time; the wrench fades.",
     "Check the cable and what else uses the bus."},
    {"reports_stopped", "link", kFault, "s", "No report came for too long; the motors are off.",
     "Check the cable, then call clear_fault() and arm()."},
    {"reports_missed", "link", kWarning, "reports", "Reports were lost on the way.",
     "Check the cable and what else uses the bus."},
    {"report_out_of_order", "link", kWarning, "", "An old report came again and was left out.",
     "Check the cable and the device's firmware."},
    {"device_restarted", "link", kFault, "",
     "The device's clock began anew, so its counts have lost their zero; the motors are off.",
     "Hold the grip at home, call clear_fault() and zero_at_home()."},
    {"write_blocked", "link", kWarning, "s", "The device does not take the tensions sent to it.",
     "Check the cable; unplug the device when it stays so."},
    {"sample_refused", "string", kWarning, "", "One impossible sample was left out.",
     "When it repeats, check the encoder's cable."},
    {"count_jump", "string", kFault, "", "An encoder jumped; the motors are off.",
     "Check the encoder's cable, zero the device, then call clear_fault() and arm()."},
    {"pose_lost", "string", kFault, "", "The lengths give no pose; the motors are off.",
     "Check the strings and the calibration, then call clear_fault() and arm()."},
    {"string_suspected", "string", kWarning, "m",
     "The string lengths began to contradict each other; the wrench fades.",
     "Look for a slack or caught string."},
    {"string_fault", "string", kFault, "m",
     "The string lengths contradict each other; the motors are off.",
     "Look for a broken, slack or caught string, then zero the device again."},
    {"string_named", "string", kWarning, "m", "This string is the one that reads wrong.",
     "Check it, then zero the device again."},
    {"fast_grip", "motion", kWarning, "m/s", "The grip is fast; the wrench fades until it slows.",
     ""},
    {"over_speed", "motion", kFault, "m/s",
     "The grip went faster than the limit; the motors are off.",
     "Hold the grip, then call clear_fault() and arm()."},
    {"workspace_edge", "motion", kInfo, "m", "The grip is at the edge of its workspace.",
     "Move it towards the centre."},
    {"motors_warm", "heat", kWarning, "", "A motor is warm; forces are reduced.",
     "Ask for less force, or wait."},
    {"overheated", "heat", kFault, "", "A motor's thermal budget is spent; forces fade.",
     "Let it cool for half a minute, then call arm()."},
    {"shaking", "motion", kWarning, "m/s", "The forces shake the grip; they are halved.",
     "Lower the stiffness or the damping."},
    {"unstable", "motion", kFault, "m/s", "The forces still shake the grip; the motors are off.",
     "Lower the stiffness or the damping, then call clear_fault() and arm()."},
    {"request_refused", "request", kWarning, "", "A request was not finite or malformed.",
     "Check the numbers that the game sends."},
    {"request_limited", "request", kInfo, "", "A request was larger than a limit allows.",
     "Ask for less, or raise the limit."},
    {"game_stalled", "game", kWarning, "s", "The game gave no sign of life; forces fade.",
     "Call arm() when the game runs again (a simulated device arms itself)."},
    {"panic_stopped", "game", kFault, "", "Panic stop: the motors are off.",
     "Call clear_fault() and arm()."},
    {"cycles_late", "timing", kWarning, "s", "Servo cycles came late.",
     "Close other programs, or lower rate_hz."},
    {"loop_stalled", "timing", kFault, "s", "The servo thread stood still; the motors are off.",
     "Check the device; then call clear_fault() and arm()."},
    {"clock_jumped", "timing", kWarning, "s", "The computer slept or its clock jumped.",
     "Call arm()."},
    {"no_real_time_priority", "timing", kInfo, "",
     "The system grants no real-time priority; cycles may come late when it is busy.",
     "On Linux allow it with a line \"@users - rtprio 50\" in /etc/security/limits.conf."},
    {"zero_needed", "calibration", kWarning, "", "The device has no zero.",
     "Hold the grip at home and call zero_at_home()."},
    {"zero_taken", "calibration", kInfo, "", "The zero is taken; it is checked by moving the grip.",
     "Move and turn the grip by some centimetres."},
    {"zero_confirmed", "calibration", kInfo, "m", "The zero fits the motion.", ""},
    {"zero_refused", "calibration", kWarning, "m", "The zero does not fit the motion.",
     "Check the strings' order and direction, hold the grip at home and call zero_at_home()."},
    {"no_hand", "state", kInfo, "", "No hand was felt, so the device did not arm.",
     "Move the grip a little, then call arm()."},
    {"impossible_tension", "state", kWarning, "",
     "The safety gate met a tension that nothing should ask for.",
     "This is a defect of the add-on: please report it."},
    {"device_stopped", "link", kFault, "",
     "The device switched its motors off itself: emergency stop, watchdog, supply, encoder or "
     "heat.",
     "The fault's text says which; remove the cause, then call clear_fault() and arm()."},
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
