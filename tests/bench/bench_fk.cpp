#include "bench/bench_fk.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "bench/daqp_clock.h"
#include "bench/methods/dense_gauss_newton.h"
#include "bench/methods/paper_polynomials.h"
#include "bench/repeated_times.h"
#include "core/calibration/string_calibration.h"
#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kTicks = 20000;
constexpr double kPeriod_s = 1e-3;
constexpr std::uint64_t kSeed = 1;
// A pose this far off has failed, where lengths are good; with noise, this many standard deviations.
constexpr double kFailure_m = 1e-3;
constexpr double kFailureSigmas = 20.0;

struct LengthSet {
    const char *name;
    double noise_m;       // standard deviation; negative: rounded to encoder counts
    bool uniform = false; // +-noise_m a string
    bool steady = false;  // the same in every tick
};

constexpr LengthSet kSets[] = {{"T1 clean", 0.0},
                               {"T1 counts", -1.0},
                               {"T1 0.1 mm", 1e-4},
                               {"T1 1 mm", 1e-3},
                               {"T1 3 mm", 3e-3},
                               {"T1 +-3 mm steady", 3e-3, true, true},
                               {"T1 +-5 mm steady", 5e-3, true, true},
                               {"T1 +-3 mm white", 3e-3, true, false},
                               {"T1 +-5 mm white", 5e-3, true, false}};

// Trajectory T1: to 0.7 m/s and 2.5 rad/s through most of the workspace.
GripPose pose_t1(const GripGeometry &grip, double t) {
    const Vec3 position(0.15 * std::sin(3.1 * t), 0.15 * std::sin(2.3 * t + 1.0),
                        0.12 * std::sin(2.9 * t + 2.0));
    const glm::dquat turn = glm::angleAxis(0.5 * std::sin(3.3 * t + 2.0), Vec3(0, 0, 1)) *
                            glm::angleAxis(0.6 * std::sin(3.7 * t + 1.0), Vec3(0, 1, 0)) *
                            glm::angleAxis(0.6 * std::sin(4.1 * t), Vec3(1, 0, 0));
    return make_pose(grip, position, glm::mat3_cast(turn), -0.5 * std::sin(2.1 * t));
}

double distance(const GripPose &a, const GripPose &b) {
    return std::max({glm::distance(a.position_m, b.position_m), glm::distance(a.r1_m, b.r1_m),
                     glm::distance(a.r2_m, b.r2_m)});
}

// One method on one set: times, worst error, failures.
struct Entry {
    explicit Entry(std::size_t ticks) : times(ticks) {}

    template <typename Method>
    void run(const Method &method, std::size_t tick, bool judge, const GripPose &truth,
             double failure_m) {
        GripPose pose;
        times.time(tick, [&] { pose = method(); });
        if (!judge) {
            return;
        }
        const double error_m = distance(pose, truth);
        if (!(error_m <= failure_m)) { // NaN too
            ++failures;
        }
        if (std::isfinite(error_m)) {
            worst_m = std::max(worst_m, error_m);
        }
    }

    RepeatedTimes times;
    double worst_m = 0.0;
    long failures = 0;
};

// Plain steps of ours from the pose of the last tick: no foreseeing, no gates.
CrossedPose plain_steps(const CrossedLayout &layout, const StringArray &lengths_m, CrossedPose pose,
                        int steps) {
    for (int i = 0; i < steps; ++i) {
        const CrossedErrors errors = errors_at(layout, lengths_m, pose);
        const CrossedFactor factor = factorise(errors, pose, layout.pole_half_length_m);
        pose = moved(pose, solve(factor, errors), layout.pole_half_length_m);
    }
    return pose;
}

class Bench {
public:
    explicit Bench(const LengthSet &set)
        : set_(set), ticks_(limited(kTicks)), entries_(kEntries, Entry(ticks_)), daqp_(ticks_) {
        usable_ = usable(warm_.configure(frame_, grip_)) &&
                  usable(cold_.configure(frame_, grip_)) && make_layout(frame_, grip_, layout_);
        std::mt19937_64 engine(kSeed);
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> uniform(-1.0, 1.0);
        StringArray errors{};
        for (std::size_t tick = 0; tick < ticks_; ++tick) {
            truths_.push_back(pose_t1(grip_, kPeriod_s * static_cast<double>(tick + 1)));
            StringArray lengths = string_lengths(frame_, grip_, truths_.back());
            for (std::size_t i = 0; i < lengths.size(); ++i) {
                if (tick == 0 || !set_.steady) {
                    errors[i] = set_.uniform ? uniform(engine) : normal(engine);
                }
                lengths[i] = set_.noise_m < 0.0 ? kPaperMetresPerCount *
                                                      std::round(lengths[i] / kPaperMetresPerCount)
                                                : lengths[i] + set_.noise_m * errors[i];
            }
            lengths_m_.push_back(lengths);
        }
    }

    bool run() {
        const double failure_m =
            std::max(kFailure_m, set_.noise_m > 0.0 ? kFailureSigmas * set_.noise_m : 0.0);
        if (!usable_) {
            return false;
        }
        in_turns(ticks_, kEntries + daqp_.methods(),
                 [&](int run, std::size_t method, std::size_t tick) {
                     if (method >= kEntries) {
                         daqp_.time(method - kEntries, tick);
                         return;
                     }
                     if (tick == 0) {
                         start(method);
                     }
                     run_method(method, run, tick, failure_m);
                 });
        return true;
    }

    void report(std::vector<BenchRow> &rows) {
        const std::size_t first = rows.size();
        for (std::size_t i = 0; i < kEntries; ++i) {
            BenchRow row;
            row.method = kNames[i].method;
            row.set = set_.name;
            row.mode = kNames[i].mode;
            entries_[i].times.fill(row);
            row.worst_error = entries_[i].worst_m;
            row.failures = entries_[i].failures;
            rows.push_back(row);
        }
        if (daqp_.ready()) {
            BenchRow warm = daqp_.warm_row();
            BenchRow cold = daqp_.cold_row();
            warm.method += std::string(", beside ") + set_.name;
            cold.method += std::string(", beside ") + set_.name;
            for (std::size_t i = first; i < rows.size(); ++i) {
                rows[i].ratio_to_daqp =
                    rows[i].median_ns / (rows[i].mode == "cold" ? cold : warm).median_ns;
            }
            rows.push_back(warm);
            rows.push_back(cold);
        }
        for (std::size_t i = first; i < rows.size(); ++i) {
            print_row(rows[i]);
        }
    }

    // Of the product itself, where nothing excuses one.
    [[nodiscard]] long failures() const {
        return set_.noise_m > 0.0 ? 0 : entries_[0].failures + entries_[1].failures;
    }

private:
    struct Name {
        const char *method;
        const char *mode;
    };
    static constexpr std::size_t kEntries = 11;
    static constexpr Name kNames[kEntries] = {{"ours", "warm"},
                                              {"ours", "cold"},
                                              {"ours, plain", "1 step"},
                                              {"ours, plain", "2 steps"},
                                              {"ours, plain", "3 steps"},
                                              {"dense damped Gauss-Newton 1e-3", "2 steps"},
                                              {"dense damped Gauss-Newton 1e-9", "2 steps"},
                                              {"paper, polynomial division", "cold"},
                                              {"paper, cubic", "cold"},
                                              {"closed form, upright pair", "cold"},
                                              {"closed form, best of four", "cold"}};

    // From the pose before the first tick, in each run.
    void start(std::size_t method) {
        const GripPose pose = pose_t1(grip_, 0.0);
        if (method == 0) {
            warm_.reset();
            warm_.set_last_pose(pose);
        } else if (method >= 2 && method < 2 + plain_.size()) {
            plain_[method - 2] = lanes_of(pose);
        } else if (method == 5) {
            shipped_ = {frame_, grip_, pose, 1e-3, 2};
        } else if (method == 6) {
            undamped_ = {frame_, grip_, pose, 1e-9, 2};
        }
    }

    void run_method(std::size_t method, int run, std::size_t tick, double failure_m) {
        const Vec3 box(kPaperHalfExtent_m);
        const double d = grip_.pole_half_length_m;
        const StringArray &lengths = lengths_m_[tick];
        const auto entry = [&](const auto &call) {
            entries_[method].run(call, tick, run == 0, truths_[tick], failure_m);
        };
        switch (method) {
        case 0:
            return entry([&] { return warm_.update(lengths).pose; });
        case 1:
            return entry([&] { return cold_.solve_cold(lengths).pose; });
        case 2:
        case 3:
        case 4:
            return entry([&] {
                CrossedPose &pose = plain_[method - 2];
                pose = plain_steps(layout_, lengths, pose, static_cast<int>(method) - 1);
                return pose_of(pose);
            });
        case 5:
            return entry([&] {
                shipped_.update(lengths);
                return shipped_.pose;
            });
        case 6:
            return entry([&] {
                undamped_.update(lengths);
                return undamped_.pose;
            });
        case 7:
            return entry([&] { return paper_division(box, d, lengths); });
        case 8:
            return entry([&] { return paper_cubic(box, d, lengths); });
        case 9:
            return entry([&] {
                return pose_of(root_pair_pose(solve_closed_form(box, d, lengths), 0).pose);
            });
        default:
            return entry([&] {
                const ClosedForm form = solve_closed_form(box, d, lengths);
                RootPairPose best = root_pair_pose(form, 0);
                for (int pair = 1; pair < kRootPairCount; ++pair) {
                    const RootPairPose other = root_pair_pose(form, pair);
                    if (other.misfit_m < best.misfit_m) {
                        best = other;
                    }
                }
                return pose_of(best.pose);
            });
        }
    }

    LengthSet set_;
    std::size_t ticks_;
    std::vector<GripPose> truths_;
    std::vector<StringArray> lengths_m_;
    FrameGeometry frame_ = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip_;
    CrossedLayout layout_;
    ForwardKinematics warm_;
    ForwardKinematics cold_;
    std::array<CrossedPose, 3> plain_{};
    DenseGaussNewton shipped_;
    DenseGaussNewton undamped_;
    std::vector<Entry> entries_;
    DaqpClock daqp_;
    bool usable_ = false;
};

} // namespace

int bench_fk(std::vector<BenchRow> &rows) {
    print_header("forward kinematics along T1 (errors in m, of P0 and the pole ends)");
    long failures = 0;
    for (const LengthSet &set : kSets) {
        Bench bench(set);
        if (!bench.run()) {
            return 1;
        }
        bench.report(rows);
        failures += bench.failures();
    }
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::bench
