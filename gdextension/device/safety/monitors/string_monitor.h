// Checks whether the eight lengths agree. They are one more than the grip's DOF; the part that no
// pose explains is the parity error. A string that sticks, slips, slackens or breaks changes it
// within milliseconds. StringFaultObserver (core) finds the string in about a second.
#pragma once

#include "core/base/sound_state.h"
#include "core/diagnosis/string_fault_observer.h"
#include "device/contract/grip_state.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class StringMonitor {
public:
    Status configure(const ServoSettings &settings) noexcept;
    // Restarts after a new zero or a cleared fault.
    void reset() noexcept;

    // Takes one good sample. moved: the pose is new. strongest_n: largest commanded tension;
    // stretch makes the lengths disagree too.
    void update(const CountArray &counts, const StringArray &lengths_m, const GripState &grip,
                bool moved, double strongest_n, double dt_s) noexcept;

    // True while the lengths disagree more than usual: the wrench must fade.
    [[nodiscard]] bool suspicious() const noexcept { return suspicious_s_ > 0.0; }
    // True once the disagreement has lasted too long, until reset(): motors off.
    [[nodiscard]] bool faulty() const noexcept { return faulty_; }
    // Finding of the observer. Its fault is `none` while the observer is not sure, or the error is
    // small.
    [[nodiscard]] const FaultEvidence &named() const noexcept { return named_; }
    // True if there is no suspicion and the same counts again would change nothing.
    [[nodiscard]] bool at_rest() const noexcept;
    // The string (0-7) that stands still or that the observer found; -1 when unknown.
    [[nodiscard]] int string() const noexcept { return string_; }
    [[nodiscard]] double parity_m() const noexcept { return parity_m_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(names_, started_, faulty_) && is_string_or_none(string_) &&
               observer_.is_sound() && spidar::is_sound(named_);
    }

private:
    struct Still { // state when the string's count last moved
        std::int32_t count = 0;
        double parity_m = 0.0;
        double still_s = 0.0;
    };

    double fade_m_ = 0.0;
    double fault_m_ = 0.0;
    StringFaultObserver observer_;
    bool names_ = false; // observer_ is configured
    FaultEvidence named_;
    std::array<Still, kStringCount> still_{};
    bool started_ = false;
    double parity_m_ = 0.0;
    double usual_m_ = 0.0; // the usual parity error: mean of the last tenths of a second
    double suspicious_s_ = 0.0;
    double large_s_ = 0.0; // time with parity above fault_m_
    double above_s_ = 0.0; // time with parity above fade_m_
    int string_ = -1;
    bool faulty_ = false;
};

} // namespace spidar
