// Reads the counters of a game's commands. Each change of a counter triggers its action once. The
// heartbeat changes with every frame and shows that the game is alive; a game that leaves it at 0
// is not watched.
#pragma once

#include <algorithm>

#include "device/contract/haptic_command.h"

namespace spidar {

class GameWatch {
public:
    struct Edges {
        bool arm = false;
        bool disarm = false;
        bool clear_fault = false;
        bool zero = false;
        bool stop = false;
        bool operator==(const Edges &) const = default;
    };

    void configure(double timeout_s) noexcept {
        *this = GameWatch();
        timeout_s_ = timeout_s;
    }
    // Takes the counters and the heartbeat of this command as already seen.
    void acknowledge(const HapticCommand &command) noexcept {
        (void)take_edges(command);
        heartbeat_ = command.heartbeat;
    }
    // Returns the counters that changed since the last call, and takes them as seen.
    Edges take_edges(const HapticCommand &command) noexcept {
        const Edges edges = edges_of(command);
        arm_count_ = command.arm_count;
        disarm_count_ = command.disarm_count;
        clear_fault_count_ = command.clear_fault_count;
        zero_count_ = command.zero_count;
        stop_count_ = command.stop_count;
        return edges;
    }
    [[nodiscard]] Edges edges_of(const HapticCommand &command) const noexcept {
        return {command.arm_count != arm_count_, command.disarm_count != disarm_count_,
                command.clear_fault_count != clear_fault_count_, command.zero_count != zero_count_,
                command.stop_count != stop_count_};
    }

    // Takes one cycle; called at rest too.
    void listen(const HapticCommand &command, double dt_s) noexcept {
        silent_s_ = beats(command) ? 0.0 : std::min(kLongest_s, silent_s_ + dt_s);
        heartbeat_ = command.heartbeat;
    }
    [[nodiscard]] bool alive() const noexcept { return silent_s_ < timeout_s_; }
    // Returns whether alive() would be true after listen().
    [[nodiscard]] bool lives_through(const HapticCommand &command, double dt_s) const noexcept {
        return beats(command) || silent_s_ + dt_s < timeout_s_;
    }
    // Time since the last heartbeat (unit: s).
    [[nodiscard]] double silent_s() const noexcept { return silent_s_; }

private:
    static constexpr double kLongest_s = 1e6; // bound of the silence

    [[nodiscard]] bool beats(const HapticCommand &command) const noexcept {
        return command.heartbeat != heartbeat_ || command.heartbeat == 0;
    }

    double timeout_s_ = 0.0;
    double silent_s_ = 0.0;
    std::uint32_t heartbeat_ = 0;
    std::uint32_t arm_count_ = 0;
    std::uint32_t disarm_count_ = 0;
    std::uint32_t clear_fault_count_ = 0;
    std::uint32_t zero_count_ = 0;
    std::uint32_t stop_count_ = 0;
};

} // namespace spidar
