// stress_shapes --cases N --seed S: a case is a random field as a mesh or a height map, smooth or in steps, of one side or
// two, and six tools at thirty placements each. The nearest contact must be as near as the nearest of all triangles, each
// looked at by itself; nothing may be told where nothing is within the margin, and a core that meets the field is told.
// Prints each failure with its case so that it replays, and the worst error; exit code 1 on a failure.
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "support/command_line.h"
#include "support/shape_samples.h"

namespace {

using namespace spidar;
using test::CaseRandom;
using test::ShapePtr;
using test::ToolPtr;

constexpr int kCells = 20;
constexpr int kPlacements = 30;
constexpr double kMargin_m = 4e-3;
// Of a gap: a tenth of an encoder count is 2.5e-6 m.
constexpr double kTolerance_m = 1e-7;

struct Counts {
    long near = 0;
    long far = 0;
    long inside = 0;
    long failures = 0;
    double worst_m = 0.0;
};

ShapePtr random_field(CaseRandom &random, double cell_m, double height_m) {
    const double x_wave = random.between(1.0, 6.0) / cell_m / 3.0;
    const double z_wave = random.between(1.0, 6.0) / cell_m / 3.0;
    const double phase = random.between(0.0, 6.0);
    const bool steps = random.below(3) == 0;
    const auto height = [&](double x, double z) {
        const double y = height_m * std::sin(x_wave * x) * std::sin(z_wave * z + phase);
        return steps ? std::round(y / height_m) * height_m : y;
    };
    ShapeDescription mesh = test::field(kCells, cell_m, height);
    ShapeDescription shape =
        random.below(2) == 0 ? mesh : test::as_height_map(mesh, kCells, cell_m);
    shape.two_sided = random.below(2) == 0;
    return test::cooked(shape);
}

std::vector<ToolPtr> random_tools(CaseRandom &random) {
    const Vec3 half(random.spread(0.003, 0.03), random.spread(0.003, 0.03),
                    random.spread(0.003, 0.03));
    return {test::tool(make_sphere(random.spread(0.002, 0.02))),
            test::tool(make_pad(0.012, 0.003, 0.003)),
            test::tool(make_pad(0.012, 0.003, 0.001)),
            test::tool(make_tool(*test::box(half))),
            test::tool(make_tool(*test::hull(test::random_points(random, 20, 0.015)))),
            test::tool(make_tool(*test::round_shape(ShapeKind::capsule, 0.004, 0.02)))};
}

// Empty: as it must be.
const char *judge(const ToolShape &tool, double exact_m, const ClosestPoints &found,
                  Counts &counts) {
    if (exact_m > kMargin_m) {
        ++counts.far;
        return found.count == 0 ? "" : "nothing is near";
    }
    if (exact_m <= -tool.skin_m()) {
        ++counts.inside;
        return found.count > 0 && found.points[0].core_inside ? "" : "the core meets the field";
    }
    if (exact_m < -tool.skin_m() + kTolerance_m) {
        return ""; // the core just touches
    }
    ++counts.near;
    const double error = std::abs(test::smallest_gap(found) - exact_m);
    counts.worst_m = std::fmax(counts.worst_m, error);
    return error <= kTolerance_m ? "" : "another gap"; // none found: infinite
}

void run_case(std::uint64_t seed, std::uint64_t number, Counts &counts) {
    CaseRandom random(seed, number);
    const double cell_m = random.spread(0.001, 0.02);
    const double height_m = random.spread(0.05, 1.0) * cell_m;
    const ShapePtr field = random_field(random, cell_m, height_m);
    const auto memory = std::make_unique<PairMemory>();
    for (const ToolPtr &tool : random_tools(random)) {
        for (int i = 0; i < kPlacements; ++i) {
            const Placement field_at{random.vector(0.1), random.rotation(3.0)};
            Placement over;
            over.origin_m = random.vector(0.4 * kCells * cell_m);
            over.origin_m.y = random.between(-0.2, 1.0) * (tool->reach_m() + height_m);
            over.rotation = random.below(3) == 0 ? Mat3(1.0) : random.rotation(3.0);
            const Placement tool_at = field_at * over;
            memory->forget();
            ClosestPoints found;
            const Status status =
                closest_points(*tool, tool_at, *field, field_at, kMargin_m, *memory, found);
            const double exact_m = test::brute_gap(*tool, tool_at, *field, field_at);
            if (std::isnan(exact_m)) {
                continue; // behind a field of one side
            }
            const char *wrong =
                status == Status::ok ? judge(*tool, exact_m, found, counts) : "refused";
            if (*wrong != '\0') {
                ++counts.failures;
                std::printf("case %llu, reach %g m, placement %d: %s: exact %.9g m, found %.9g m "
                            "of %d\n",
                            static_cast<unsigned long long>(number), tool->reach_m(), i, wrong,
                            exact_m, test::smallest_gap(found), found.count);
            }
        }
    }
}

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 100);
    const auto seed = static_cast<std::uint64_t>(test::whole_option(argc, argv, "--seed", 1));
    Counts counts;
    for (long i = 0; i < cases; ++i) {
        run_case(seed, static_cast<std::uint64_t>(i), counts);
    }
    std::printf("stress_shapes: %ld cases: %ld near, %ld far, %ld inside; worst error of a gap "
                "%.3g m; %ld failures\n",
                cases, counts.near, counts.far, counts.inside, counts.worst_m, counts.failures);
    return counts.failures == 0 && counts.near > 0 ? 0 : 1;
}
