// I^2 t model: the heat of each motor's winding from its commanded tensions. Heat follows the
// squared tension with the winding's time constant; the budget is the heat of the continuous
// tension.
#pragma once

#include "core/base/types.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class ThermalBudget {
public:
    void configure(const SafetySettings &safety) noexcept;
    // Takes one cycle at these tensions (unit: N). A tension that is not finite, or above 1000
    // times the continuous one, counts as 0.
    void spend(const StringArray &tensions_n, double dt_s) noexcept;

    // True below kDerateFrom, where the heat scales nothing down. spend() must be called at rest
    // too.
    [[nodiscard]] bool at_rest() const noexcept { return spent() < kDerateFrom; }
    // Used share of the warmest motor's budget; 1: the largest heat that is allowed.
    [[nodiscard]] double spent() const noexcept { return warmest_; }
    // True when the budget is spent. NaN counts as spent.
    [[nodiscard]] bool is_spent() const noexcept { return !(warmest_ < 1.0); }
    // Used share of each motor's budget. It outlasts a loop (safety/motor_heat.h).
    [[nodiscard]] const StringArray &heat() const noexcept { return heat_; }
    void set_heat(const StringArray &heat) noexcept;
    [[nodiscard]] int warmest_string() const noexcept;
    // Scale of the forces: 1 up to kDerateFrom, then linearly down to 0 at the whole budget.
    [[nodiscard]] double scale() const noexcept;

    static constexpr double kDerateFrom = 0.7;

private:
    void find_warmest() noexcept;

    StringArray heat_{}; // used share of the budget
    double share_per_n2_ = 0.0;
    double rate_1_s_ = 0.0;
    double warmest_ = 0.0;
};

} // namespace spidar
