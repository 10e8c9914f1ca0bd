// The table of faults in docs/reference/safety.md, as tests: one row a fault. test_fault_table.cpp runs every row with every
// hand and fails when a row of the page has no test here.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "support/servo_fixture.h"

namespace spidar::test {

// What a row measured.
struct Answer {
    double response_ms = -1.0;   // from the fault to the answer; < 0: none came
    double tension_n = 0.0;      // largest since the fault, of what the motors were told
    double energy_j = 0.0;       // given to the hand since the fault, at its largest
    double peak_speed_m_s = 0.0; // of the grip since the fault
};

struct FaultRow {
    int number;
    const char *fault;
    double limit_ms; // of the response
    // Of a grip that a hand holds: at most 50 mJ. A released one: peak speed (unit: m/s); 0: held.
    double released_limit_m_s;
    Answer (*run)(HandFirmness hand);
    // Where a row is tested that needs a game, an operating system or a thread: file and name of the test there.
    const char *file = nullptr;
    const char *test = nullptr;
};

[[nodiscard]] std::span<const FaultRow> rows_of_game();    // 1-3, 9-14, 38
[[nodiscard]] std::span<const FaultRow> rows_of_link();    // 4-8, 15-17, 29
[[nodiscard]] std::span<const FaultRow> rows_of_strings(); // 18-22, 36
[[nodiscard]] std::span<const FaultRow> rows_of_motion();  // 23-26

// A simulated device in play, stepped at 1 kHz, with a game at 62.5 Hz.
struct FaultRig {
    explicit FaultRig(HandFirmness hand, const PlantSettings &from = PlantSettings());

    // One millisecond.
    void tick();
    void run_ms(int ms);
    // Forces on, the ramp over, `wrench` asked for.
    void activate();
    void ask(const Wrench &wrench) { asked = wrench; }
    void move_hand(const Vec3 &position_m, double grasp_angle_rad = 0.0);
    bool inject(SimulatedFault fault, int string = 0, double duration_s = 0.0);
    // From here on the answer is measured.
    void mark();
    // Milliseconds from mark() until `condition` holds; -1 when it does not within most_ms.
    template <typename Condition>
    double until(Condition condition, int most_ms) {
        for (int ms = 0; ms <= most_ms; ++ms) {
            if (condition(now)) {
                return static_cast<double>(ticks - marked_at);
            }
            tick();
        }
        return -1.0;
    }
    [[nodiscard]] Answer answer(double response_ms) const {
        return {response_ms, tension_n, energy_j, peak_speed_m_s};
    }
    [[nodiscard]] bool motors_off() const { return now.tensions_n == StringArray{}; }
    [[nodiscard]] int events_of(DeviceEventKind kind) const;

    SimulatedTransport *device = nullptr;
    std::unique_ptr<ServoLoop> loop;
    ServoSettings settings;
    HapticCommand command;
    ServoSnapshot now;
    Wrench asked;
    bool game_runs = true;      // publishes each 16 ms
    bool contacts_renew = true; // with its contacts
    // Where the hand goes, unless still: a circle of 3 cm at 0.15 m/s.
    bool hand_moves = false;
    Vec3 hand_m{0.0};
    double hand_grasp_rad = 0.0;
    long ticks = 0;
    long marked_at = 0;
    double energy_at_mark_j = 0.0;
    double tension_n = 0.0;
    double energy_j = 0.0;
    double peak_speed_m_s = 0.0;
    std::vector<DeviceEvent> events;
};

} // namespace spidar::test
