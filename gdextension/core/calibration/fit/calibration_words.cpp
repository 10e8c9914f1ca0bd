// Sentences that self-calibration shows to the user.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/describe_value.h"
#include "core/base/finite.h"
#include "core/calibration/fit/self_calibration.h"

namespace spidar {

namespace {

// Largest number of parts in a description, and the smallest share that is named.
constexpr std::size_t kNamedParts = 4;
constexpr double kNamedShare = 0.2;

} // namespace

std::string validate(const SelfCalibrationSettings &settings) {
    if (!positive_finite(settings.offset_prior_m)) {
        return range_sentence(
            "offset_prior_m", settings.offset_prior_m, "m",
            "give how far the offsets may be off at the start, for instance 0.02.");
    }
    if (!positive_finite(settings.gain_prior)) {
        return range_sentence("gain_prior", settings.gain_prior, "m/m",
                              "give how far the gains may be off, for instance 0.05.");
    }
    if (!positive_finite(settings.winding_prior_1_m)) {
        return range_sentence("winding_prior_1_m", settings.winding_prior_1_m, "1/m",
                              "give how large the winding curvature may be, for instance 0.1.");
    }
    if (!positive_finite(settings.size_prior)) {
        return range_sentence("size_prior", settings.size_prior, "m/m",
                              "give how far the sizes may be off, for instance 0.02.");
    }
    if (!(settings.central_share > 0.0) || !(settings.central_share <= settings.middle_share) ||
        !(settings.middle_share <= 1.0)) {
        return range_sentence("central_share", settings.central_share, "of the poses",
                              "give 0 < central_share <= middle_share <= 1.");
    }
    if (!(settings.min_singular >= 0.0) || !(settings.min_singular < 1.0)) {
        return range_sentence("min_singular", settings.min_singular, "m/m",
                              "give 0 to 1; 0.25 keeps poses that determine the grip well.");
    }
    if (!(settings.outlier_sigmas >= 1.0)) {
        return range_sentence("outlier_sigmas", settings.outlier_sigmas, "sigma",
                              "give 1 or more; 5 is usual.");
    }
    if ((settings.fit_winding || settings.fit_sizes) && !settings.fit_gains) {
        return "fit_gains is false, but winding and sizes can be separated from the gains only if "
               "the gains are fitted too; set fit_gains.";
    }
    return {};
}

std::string unknown_name(std::size_t unknown) {
    constexpr std::array<const char *, 4> kSizes{"frame size along x", "frame size along y",
                                                 "frame size along z", "pole length"};
    const std::string string = " of string " + std::to_string(unknown % kStringCount + 1);
    if (unknown < kGainUnknowns) {
        return "offset" + string;
    }
    if (unknown < kWindingUnknowns) {
        return "gain" + string;
    }
    if (unknown < kSizeUnknowns) {
        return "winding" + string;
    }
    return unknown < kCalibrationUnknowns ? kSizes[unknown - kSizeUnknowns] : "no unknown";
}

std::string describe(const WeakCombination &combination) {
    std::array<std::size_t, kCalibrationUnknowns> order{};
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::fabs(combination.coefficients[a]) > std::fabs(combination.coefficients[b]);
    });
    std::string text = "known only to " +
                       std::to_string(static_cast<int>(std::lround(100 * combination.left_open))) +
                       " % of the assumed error:";
    for (std::size_t k = 0; k < kNamedParts; ++k) {
        const double part = combination.coefficients[order[k]];
        if (k == 0 || std::fabs(part) >= kNamedShare) {
            text += (part < 0.0 ? " - " : " + ") + unknown_name(order[k]);
        }
    }
    return text;
}

} // namespace spidar
