// Show 4: along trajectory T1 without its zeros, slew limiter off, the shipped settings keep tensions from jumping and
// cost next to no wrench beside a ridge of 1e-6 alone.
#include <cmath>
#include <cstdio>

#include <doctest/doctest.h>

#include "core/tension/tension_solver.h"
#include "support/trajectory_t1.h"

using namespace spidar;

namespace {

struct Figures {
    double largest_jump_n = 0.0;
    double error_rms_n = 0.0; // of the weighted wrench
};

Figures along_t1(const TensionSettings &settings) {
    constexpr int kTicks = 60000;
    TensionSolver solver;
    REQUIRE(solver.configure(settings) == Status::ok);
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    const GripGeometry grip;
    const PaperWeights weights = tension_weights(settings);
    Figures figures;
    StringArray last{};
    double squares = 0.0;
    for (int tick = 0; tick < kTicks; ++tick) {
        const double t_s = 0.001 * tick;
        const WrenchMatrix matrix = wrench_matrix(frame, grip, test::t1_pose(grip, t_s));
        const PaperWrench wrench = test::t1_wrench(t_s);
        const StringArray tensions = solver.update(matrix, wrench).tensions_n;
        const PaperWrench given = apply(matrix, tensions);
        for (std::size_t k = 0; k < wrench.size(); ++k) {
            const double error_n = weights[k] * (given[k] - wrench[k]);
            squares += error_n * error_n;
        }
        for (std::size_t i = 0; tick > 0 && i < tensions.size(); ++i) {
            figures.largest_jump_n =
                std::fmax(figures.largest_jump_n, std::abs(tensions[i] - last[i]));
        }
        last = tensions;
    }
    figures.error_rms_n = std::sqrt(squares / kTicks);
    return figures;
}

} // namespace

TEST_CASE(
    "tension jumps: T1 at shipped settings, at most 0.6 N a tick for at most 0.5 % of wrench") {
    TensionSettings bare;
    bare.ridge = 1e-6;
    bare.reference_weight = 0.0;
    bare.change_weight = 0.0;
    const Figures ridge_alone = along_t1(bare);
    const Figures shipped = along_t1({});
    const double more = shipped.error_rms_n / ridge_alone.error_rms_n - 1.0;
    std::printf("T1 without zeros: largest tension change a tick %.3f N (ridge 1e-6 alone: %.3f "
                "N); rms wrench "
                "error %.6f N (%.6f N): %+.3f %%\n",
                shipped.largest_jump_n, ridge_alone.largest_jump_n, shipped.error_rms_n,
                ridge_alone.error_rms_n, 100.0 * more);
    CHECK(shipped.largest_jump_n <= 0.6);
    CHECK(more <= 0.005);
    CHECK(ridge_alone.largest_jump_n > 0.6); // there was something to limit
}
