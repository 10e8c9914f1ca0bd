// Finds the pose when there is no last pose, or when the steps from it fail. The search polishes
// several starts and reports the best pose, and whether another fits as well. For eyelets, root
// pairs whose misfit is too large to win are skipped.
#pragma once

#include <optional>

#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/steps/crossed_step.h"
#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Poses further apart than this (grip center or pole end) are different answers.
inline constexpr double kDistinctPose_m = 1e-5;

// What a search may use besides the problem.
struct SearchTools {
    // The fast steps; null unless strings leave from eyelets, two to each pole end.
    const CrossedLayout *layout = nullptr;
    // Set when the closed form applies: a box frame and the paper's attachments.
    std::optional<Vec3> closed_form_half_extents_m;
    // Lengths converted to eyelets, for the closed form over pulleys. Null: the problem's lengths.
    const StringArray *eyelet_lengths_m = nullptr;
};

struct SearchResult {
    PolishResult best;
    bool any = false;       // false: no pose had a finite residual
    bool ambiguous = false; // another pose, more than kDistinctPose_m away, fits as well
    int steps = 0;
};

// Tries the remembered pose (nullptr: none), then the upright root pair, then the others. Ends
// early when the remembered pose leads to a residual of at most content_m.
[[nodiscard]] SearchResult search_pose(const LengthProblem &problem, const SearchTools &tools,
                                       const GripPose *remembered, double content_m) noexcept;

// Result of a search for other poses than the one that a warm tick found.
struct RivalResult {
    bool ambiguous = false; // another pose fits as well or better
    // True when `best` should replace the known pose: it fits clearly better, or it fits within the
    // noise and is upright while the known pose is not.
    bool preferable = false;
    PolishResult best;
};

// noise_m: recent level of the residual (rms over the strings). Without a closed form it tries
// seven starts, in about 50 us.
[[nodiscard]] RivalResult find_rival(const LengthProblem &problem, const SearchTools &tools,
                                     const PolishResult &known, double noise_m) noexcept;

} // namespace spidar
