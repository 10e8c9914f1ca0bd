#include "device/step/tension_diagnosis.h"

#include <algorithm>

namespace spidar {

TensionSettings solver_settings(const ServoSettings &settings) noexcept {
    TensionSettings tension = settings.tension;
    for (const double strongest_n : max_tensions(settings.motors)) {
        tension.max_tension_n = std::min(tension.max_tension_n, strongest_n);
    }
    if (settings.grip.kind == GripKind::rigid) {
        tension.dof_mask &= kNoGrasp;
    }
    return tension;
}

TensionReport tension_report(const ServoSettings &settings,
                             const ServoSnapshot &snapshot) noexcept {
    const double ramp = snapshot.tension_scale;
    const bool on = std::any_of(snapshot.tensions_n.begin(), snapshot.tensions_n.end(),
                                [](double tension_n) { return tension_n != 0.0; });
    if (!on || !(ramp > 0.0)) {
        return {};
    }
    const WrenchMatrix matrix = wrench_matrix(settings.frame, settings.grip, snapshot.grip.pose);
    PaperWrench wrench = to_paper(snapshot.requested);
    StringArray tensions_n = snapshot.tensions_n;
    for (double &value : wrench) {
        value /= ramp;
    }
    for (double &value : tensions_n) {
        value /= ramp;
    }
    TensionReport report = tension_report(matrix, wrench, tensions_n, solver_settings(settings));
    for (PaperWrench *share : {&report.achieved, &report.error, &report.limits, &report.ridge,
                               &report.reference, &report.transient}) {
        for (double &value : *share) {
            value *= ramp;
        }
    }
    return report;
}

} // namespace spidar
