#include "device/safety/monitors/thermal_budget.h"

#include <algorithm>
#include <cmath>

namespace spidar {

void ThermalBudget::configure(const SafetySettings &safety) noexcept {
    *this = ThermalBudget();
    share_per_n2_ = 1.0 / (safety.continuous_tension_n * safety.continuous_tension_n);
    rate_1_s_ = 1.0 / safety.thermal_time_s;
}

void ThermalBudget::spend(const StringArray &tensions_n, double dt_s) noexcept {
    const double gain = std::min(1.0, dt_s * rate_1_s_);
    for (std::size_t i = 0; i < heat_.size(); ++i) {
        const double square = tensions_n[i] * tensions_n[i] * share_per_n2_;
        // NaN and absurd values do not heat.
        heat_[i] += gain * ((square < 1e6 ? square : 0.0) - heat_[i]);
    }
    find_warmest();
}

void ThermalBudget::set_heat(const StringArray &heat) noexcept {
    heat_ = heat;
    find_warmest();
}

void ThermalBudget::find_warmest() noexcept {
    const auto &h = heat_;
    warmest_ = std::max(std::max(std::max(h[0], h[1]), std::max(h[2], h[3])),
                        std::max(std::max(h[4], h[5]), std::max(h[6], h[7])));
}

int ThermalBudget::warmest_string() const noexcept {
    return static_cast<int>(std::max_element(heat_.begin(), heat_.end()) - heat_.begin());
}

double ThermalBudget::scale() const noexcept {
    return std::clamp((1.0 - warmest_) / (1.0 - kDerateFrom), 0.0, 1.0);
}

} // namespace spidar
