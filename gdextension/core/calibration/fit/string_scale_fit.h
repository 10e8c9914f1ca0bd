// Scale of one string on the bench: encoder counts against lengths read off a ruler, fitted by
// least squares (paper, section VI.1, method 2; Table 1 holds its data). Allocates: not for the
// servo loop.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/status.h"

namespace spidar {

struct CountLengthPair {
    std::int32_t count = 0;
    double length_m = 0.0; // read off the ruler; equal values are repeated trials of one point
};

struct StringScaleFit {
    // ok; too_few_samples below two different counts; not_finite. Negative: all values are zero.
    Status status = Status::too_few_samples;
    double offset_m = 0.0;                // length at count 0
    double scale_m_per_count = 0.0;       // negative: counts fall in paying out
    double scale_error_m_per_count = 0.0; // standard error of the scale; 0 for two pairs
    double residual_rms_m = 0.0;          // of the fit
    double residual_max_m = 0.0;
    // Spread of repeated trials about their mean (unit: m of string), pooled over all points with
    // two or more trials. A residual much larger than the spread means that the lengths follow a
    // curve (winding).
    double repeat_spread_m = 0.0;
    int repeated_points = 0;
};

[[nodiscard]] StringScaleFit fit_string_scale(const std::vector<CountLengthPair> &pairs);

} // namespace spidar
