// Very many tension problems, ordinary and hostile, each checked by its KKT conditions in long double: quick enough for
// 1e9 in about an hour of one core. stress_tension checks fewer against an exact optimum.
//   stress_tension_quick [--cases N] [--seed S]; a case replays alone with --cases 1 --seed ITS_SEED.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/base/simd_level.h"
#include "core/tension/tension_solver.h"

namespace {

using namespace spidar;

constexpr std::size_t kStrings = 8;
constexpr std::size_t kDofs = 7;
// KKT violation as a share of the largest force that cancels in a slope; a step of 1e-13 N, where corrections end,
// makes 2e-12 of it.
constexpr long double kViolation = 1e-11L;
// A violation that comes from, or leads to, no larger error of a tension than this is none.
constexpr long double kTensionError_n = 1e-11L;
// Beyond this, squares of squares overflow and the solver may say not_converged.
constexpr double kTame = 1e60;
// Stiffness of a string, (W A)^2, over the proximal weight. A factorisation in double keeps 16 digits of its root, and the
// refinement needs some three of them: beyond, a problem may be refused with a status (two in 5 x 10^8 were, at 10^29 and
// 10^31; the device's own is 10^9 with the ridge alone).
constexpr double kWorstStiffness = 1e26;

// SplitMix64: a case costs no more to seed than to solve.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31U);
    }
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 11U) * 0x1p-53;
    }
    bool one_in(unsigned n) { return bits() % n == 0; }

private:
    std::uint64_t state_;
};

Vec3 direction(Dice &dice) {
    Vec3 v(dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(-1, 1));
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 1e-3 ? v / length : Vec3(1, 0, 0);
}

double hostile(Dice &dice) {
    switch (dice.bits() % 10) {
    case 0:
        return std::nan("");
    case 1:
        return HUGE_VAL;
    case 2:
        return -HUGE_VAL;
    case 3:
        return 5e-324;
    case 4:
        return -1e-310;
    case 5:
        return 1e300;
    case 6:
        return -1e155;
    case 7:
        return 1e-200;
    case 8:
        return 0.0;
    default:
        return std::bit_cast<double>(dice.bits());
    }
}

TensionProblem ordinary(Dice &dice) {
    static const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    static const GripGeometry grip;
    const double d = kPaperPoleHalfLength_m;
    GripPose pose;
    const double reach = dice.one_in(4) ? 0.45 : 0.2;
    pose.position_m =
        Vec3(dice.uniform(-reach, reach), dice.uniform(-reach, reach), dice.uniform(-reach, reach));
    pose.r1_m = d * direction(dice);
    pose.r2_m = d * direction(dice);
    switch (dice.bits() % 12) {
    case 0: // parallel poles
        pose.r2_m = dice.one_in(2) ? pose.r1_m : -1.0 * pose.r1_m;
        break;
    case 1: // a quarter turn at the centre: rank lost
        pose.position_m = Vec3(0.0);
        pose.r1_m = Vec3(-d, 0.0, 0.0);
        pose.r2_m = Vec3(0.0, d, 0.0);
        break;
    case 2: // an end on a motor
        pose.position_m = frame.motors_m[dice.bits() % kStrings] - pose.r1_m;
        break;
    default:
        break;
    }
    TensionProblem p;
    p.matrix = wrench_matrix(frame, grip, pose);
    const double size = dice.one_in(4) ? dice.uniform(10, 300) : dice.uniform(0, 6);
    for (std::size_t k = 0; k < kDofs; ++k) {
        p.wrench[k] = dice.one_in(6) ? 0.0 : dice.uniform(-size, size) * (k < 3 ? 1.0 : 0.04);
    }
    p.weights = {1, 1, 1, 25, 25, 25, 25};
    switch (dice.bits() % 8) {
    case 0:
        p.weights = {1, 1, 1, 0, 0, 0, 0};
        break;
    case 1:
        p.weights[6] = 0.0;
        break;
    case 2:
        p.weights[dice.bits() % kDofs] = 0.0;
        break;
    default:
        break;
    }
    const double exponents[] = {-0.5, -1, -2, -3, -3, -6, -9, -12};
    p.proximal_weight = std::pow(10.0, exponents[dice.bits() % 8]);
    const double lower = dice.one_in(3) ? 0.0 : dice.uniform(0.05, 1.0);
    const double upper = dice.one_in(2) ? 10.0 : dice.uniform(1.5, 20.0);
    for (std::size_t i = 0; i < kStrings; ++i) {
        p.lower_n[i] = lower;
        p.upper_n[i] = dice.one_in(30) ? lower : upper; // equal bounds
        p.proximal_target_n[i] = dice.one_in(3) ? lower : dice.uniform(lower, upper);
        if (dice.one_in(40)) { // broken
            p.lower_n[i] = p.upper_n[i] = p.proximal_target_n[i] = 0.0;
        }
    }
    return p;
}

void spoil(Dice &dice, TensionProblem &p) {
    for (std::uint64_t count = 1 + dice.bits() % 3; count > 0; --count) {
        const std::size_t i = dice.bits() % kStrings;
        const std::size_t k = dice.bits() % kDofs;
        switch (dice.bits() % 8) {
        case 0:
            p.matrix.columns[i][k] = hostile(dice);
            break;
        case 1:
            p.wrench[k] = hostile(dice);
            break;
        case 2:
            p.weights[k] = hostile(dice);
            break;
        case 3:
            p.proximal_weight = hostile(dice);
            break;
        case 4:
            p.proximal_target_n[i] = hostile(dice);
            break;
        case 5:
            p.lower_n[i] = hostile(dice);
            break;
        case 6:
            p.upper_n[i] = hostile(dice);
            break;
        default: { // scales of the whole problem
            const double scale = std::pow(10.0, dice.uniform(-80, 80));
            for (PaperWrench &column : p.matrix.columns) {
                for (double &value : column) {
                    value *= scale;
                }
            }
            break;
        }
        }
    }
}

struct Judgement {
    const char *broken = nullptr;
    long double violation = 0.0L; // share of the forces that cancel
    bool flagged = false;
};

Judgement judge(const TensionProblem &p, const TensionSolution &solution) {
    Judgement result;
    bool usable_input = p.proximal_weight > 0.0 && std::isfinite(p.proximal_weight);
    double size = p.proximal_weight;
    const auto include = [&](double value) {
        usable_input = usable_input && std::isfinite(value);
        size = std::fmax(size, std::abs(value));
    };
    for (std::size_t i = 0; i < kStrings; ++i) {
        include(p.lower_n[i]);
        include(p.upper_n[i]);
        include(p.proximal_target_n[i]);
        usable_input = usable_input && p.lower_n[i] <= p.upper_n[i];
        if (!std::isfinite(solution.tensions_n[i])) {
            result.broken = "a tension is not finite";
            return result;
        }
    }
    double stiffest = 0.0;
    for (std::size_t k = 0; k < kDofs; ++k) {
        include(p.weights[k]);
        include(p.wrench[k]);
        for (std::size_t i = 0; i < kStrings; ++i) {
            include(p.matrix.columns[i][k]);
            const double entry = p.weights[k] * p.matrix.columns[i][k];
            stiffest = std::fmax(stiffest, entry * entry);
        }
    }
    result.flagged = solution.status != Status::ok;
    if (!usable_input) {
        // DOF of no weight at the end may be left unread: then the rest decides, and is checked no further.
        const bool reads_all = p.weights[6] != 0.0;
        result.broken =
            !result.flagged && reads_all ? "impossible input got the status ok" : nullptr;
        return result;
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
        const double x = solution.tensions_n[i];
        const bool inside = x >= p.lower_n[i] && x <= p.upper_n[i];
        if (!inside && (!result.flagged || p.upper_n[i] >= 0.0)) {
            result.broken = x >= 0.0 && result.flagged && x <= std::fmax(0.0, p.upper_n[i])
                                ? nullptr
                                : "a tension is out of bounds";
            if (result.broken != nullptr) {
                return result;
            }
        }
    }
    if (result.flagged) {
        const bool solvable = stiffest <= kWorstStiffness * p.proximal_weight;
        result.broken = solvable && p.proximal_weight > 1e-13 && size < 1e6
                            ? "an ordinary problem was not solved"
                            : nullptr;
        return result;
    }
    if (!(size < kTame)) {
        return result; // long double squares of it mean nothing
    }
    long double force[kDofs];
    for (std::size_t k = 0; k < kDofs; ++k) {
        long double sum = -static_cast<long double>(p.wrench[k]);
        for (std::size_t i = 0; i < kStrings; ++i) {
            sum += static_cast<long double>(p.matrix.columns[i][k]) * solution.tensions_n[i];
        }
        force[k] = static_cast<long double>(p.weights[k]) * p.weights[k] * sum;
    }
    long double scale = 0.0L;
    long double worst = 0.0L;
    long double stiffness = p.proximal_weight;
    for (std::size_t i = 0; i < kStrings; ++i) {
        const double x = solution.tensions_n[i];
        const long double away = static_cast<long double>(x) - p.proximal_target_n[i];
        long double slope = p.proximal_weight * away;
        // What cancels in it, and what its rounding is a share of.
        long double sizes = static_cast<long double>(p.proximal_weight) *
                            (std::abs(x) + std::abs(p.proximal_target_n[i]));
        for (std::size_t k = 0; k < kDofs; ++k) {
            const long double term = force[k] * p.matrix.columns[i][k];
            slope += term;
            const long double row = static_cast<long double>(p.weights[k]) * p.matrix.columns[i][k];
            stiffness += row * row;
            sizes += std::abs(term);
            const long double square = static_cast<long double>(p.weights[k]) * p.weights[k];
            sizes += square * std::abs(static_cast<long double>(p.matrix.columns[i][k])) *
                     (std::abs(static_cast<long double>(p.wrench[k])) +
                      std::abs(static_cast<long double>(p.matrix.columns[i][k]) * x));
        }
        scale = std::fmax(scale, sizes);
        const bool low = x <= p.lower_n[i];
        const bool high = x >= p.upper_n[i];
        const long double wrong = low && high ? 0.0L
                                  : low       ? std::fmax(0.0L, -slope)
                                  : high      ? std::fmax(0.0L, slope)
                                              : std::abs(slope);
        worst = std::fmax(worst, wrong);
    }
    result.violation = scale > 0.0L ? worst / scale : 0.0L;
    // The objective is w-strongly convex: the tensions are within |violation| / w of the optimum. And a step of that
    // size in one string makes a violation of |H| times it.
    if (!(worst > kTensionError_n * p.proximal_weight) || !(worst > kTensionError_n * stiffness)) {
        result.violation = 0.0L;
    }
    if (!(result.violation <= kViolation)) {
        result.broken = "the KKT conditions are violated";
    }
    return result;
}

} // namespace

int main(int argc, char **argv) {
    unsigned long long cases = 1000000;
    unsigned long long seed = 1;
    for (int i = 1; i < argc; i += 2) {
        char *end = nullptr;
        const unsigned long long value = i + 1 < argc ? std::strtoull(argv[i + 1], &end, 10) : 0;
        const bool number = end != nullptr && *end == '\0' && end != argv[i + 1];
        if (number && std::strcmp(argv[i], "--cases") == 0 && value > 0) {
            cases = value;
        } else if (number && std::strcmp(argv[i], "--seed") == 0) {
            seed = value;
        } else {
            std::fprintf(stderr, "usage: stress_tension_quick [--cases N>0] [--seed S]\n");
            return 2;
        }
    }
    unsigned long long failures = 0;
    unsigned long long hostile_cases = 0;
    unsigned long long flagged = 0;
    long double worst = 0.0L;
    unsigned long long worst_seed = seed;
    ActiveSet last{};
    for (unsigned long long n = 0; n < cases; ++n) {
        Dice dice(seed + n);
        TensionProblem problem = ordinary(dice);
        const bool spoiled = dice.one_in(4);
        if (spoiled) {
            spoil(dice, problem);
            ++hostile_cases;
        }
        const SimdLevel level = dice.one_in(2) ? SimdLevel::plain : best_simd_level();
        for (StringBound &bound : last) { // any guess may cost time only
            bound = static_cast<StringBound>(dice.bits() % 3);
        }
        const TensionSolution solution =
            solve_tension_problem(problem, dice.one_in(2) ? &last : nullptr, level);
        const Judgement judgement = judge(problem, solution);
        flagged += judgement.flagged ? 1U : 0U;
        if (judgement.violation > worst) {
            worst = judgement.violation;
            worst_seed = seed + n;
        }
        if (judgement.broken != nullptr) {
            ++failures;
            if (failures <= 20) {
                std::printf("FAILED: %s (%s, violation %.3Lg); replay: --cases 1 --seed %llu\n",
                            judgement.broken, describe(solution.status), judgement.violation,
                            seed + n);
            }
        }
    }
    std::printf("stress_tension_quick: %llu problems from seed %llu, %llu of them hostile, %llu "
                "refused with a status; worst KKT violation %.3Lg of the forces (seed %llu); %llu "
                "failures\n",
                cases, seed, hostile_cases, flagged, worst, worst_seed, failures);
    return failures == 0 ? 0 : 1;
}
