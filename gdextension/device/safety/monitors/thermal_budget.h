// I^2 t: how warm each motor's winding is, from the tensions it was told to pull. Heat follows the squared tension
// with the winding's time constant; the budget is what the continuous tension heats to.
#pragma once

#include "core/base/types.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class ThermalBudget {
public:
    void configure(const SafetySettings &safety) noexcept;
    // One cycle at these tensions (unit: N). What is not finite heats nothing.
    void spend(const StringArray &tensions_n, double dt_s) noexcept;

    // The same tensions change nothing but the heat: spend() goes on at rest, too.
    [[nodiscard]] bool at_rest() const noexcept { return spent() < kDerateFrom; }
    // Share of the warmest motor's budget that is spent: 1 = as warm as it may be.
    [[nodiscard]] double spent() const noexcept { return warmest_; }
    // NaN counts as too warm.
    [[nodiscard]] bool is_spent() const noexcept { return !(warmest_ < 1.0); }
    // Share of its budget that each motor has spent: what outlasts a loop (safety/motor_heat.h).
    [[nodiscard]] const StringArray &heat() const noexcept { return heat_; }
    void set_heat(const StringArray &heat) noexcept;
    [[nodiscard]] int warmest_string() const noexcept;
    // 1 up to kDerateFrom of the budget, then down to 0 at all of it, in a straight line.
    [[nodiscard]] double scale() const noexcept;

    static constexpr double kDerateFrom = 0.7;

private:
    void find_warmest() noexcept;

    StringArray heat_{}; // share of the budget
    double share_per_n2_ = 0.0;
    double rate_1_s_ = 0.0;
    double warmest_ = 0.0;
};

} // namespace spidar
