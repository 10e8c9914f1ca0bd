// Kinematics from no memory, or when memory fails: every pose worth trying, the best of them, and whether another fits
// as well. Root pairs that cannot win are dropped by their misfit before anything is spent on them.
#pragma once

#include <optional>

#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/steps/crossed_step.h"
#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Two poses further apart than this (grip centre or pole end) are different answers, not rounding.
inline constexpr double kDistinctPose_m = 1e-5;

// What a search may use besides the problem itself.
struct SearchTools {
    const CrossedLayout *layout = nullptr; // eyelets, two strings to each pole end: the fast steps
    std::optional<Vec3>
        closed_form_half_extents_m; // a box and the paper's strings: the closed form
    // The lengths that it takes where strings leave over pulleys: about those from eyelets. Null: the problem's.
    const StringArray *eyelet_lengths_m = nullptr;
};

struct SearchResult {
    PolishResult best;
    bool any = false;       // false: not even a finite residual
    bool ambiguous = false; // another pose, kDistinctPose_m or more away, fits as well
    int steps = 0;
};

// The remembered pose first (none: nullptr), then the upright root pair, then the others. Nothing more is tried when
// the remembered pose leads to a residual of at most `content_m`.
[[nodiscard]] SearchResult search_pose(const LengthProblem &problem, const SearchTools &tools,
                                       const GripPose *remembered, double content_m) noexcept;

// What a look for other poses than the one that a warm tick found says.
struct RivalResult {
    bool ambiguous = false; // another pose fits these lengths as well
    bool preferable =
        false; // `best` is a better answer: it fits clearly better, or as well as lengths of this noise fit,
    // and is upright where the known pose is not
    PolishResult best;
};

// noise_m: recent level of the residual (root mean square over the strings). Without a closed form all seven starts are
// tried, which takes some 50 us.
[[nodiscard]] RivalResult find_rival(const LengthProblem &problem, const SearchTools &tools,
                                     const PolishResult &known, double noise_m) noexcept;

} // namespace spidar
