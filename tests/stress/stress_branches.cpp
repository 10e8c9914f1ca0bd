// stress_branches --cases N --seed S: cold starts on the 60/45 set (P0 in +-20 cm, Rz Ry Rx each in +-60 degrees, psi
// 90 +-45 degrees) at several length errors. How often is the pose of another root pair taken for the true one, against
// how often it must be taken by whoever goes by the lengths alone: when it fits them at least as well as the truth?
// Exit code 1 when a wrong branch is more frequent than that, or with exact lengths there is one at all.
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/calibration/string_calibration.h"
#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/search/pose_search.h"
#include "support/command_line.h"
#include "support/pose_helpers.h"

namespace {

using namespace spidar;
using test::kDeg;

struct LengthErrorKind {
    const char *name;
    double noise_m; // standard deviation; negative: rounded to encoder counts
};

constexpr LengthErrorKind kKinds[] = {
    {"exact", 0.0}, {"counts", -1.0}, {"0.1 mm", 1e-4}, {"1 mm", 1e-3}, {"3 mm", 3e-3}};

struct Rates {
    long cases = 0;
    long refused = 0;
    long not_upright = 0;     // the truth is another pair than the upright one
    long ambiguous = 0;       // some other pose fits at least as well as the true branch
    long flagged = 0;         // ambiguous_pose
    long wrong = 0;           // another branch than the true one was taken
    long wrong_unflagged = 0; // and nothing said so
    long first_wrong = -1;    // case to replay
};

double normal(test::Random &random) { // sum of 12 uniforms: the same everywhere
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
        sum += random.between(0.0, 1.0);
    }
    return sum;
}

StringArray with_errors(StringArray lengths, const LengthErrorKind &kind, test::Random &random) {
    for (double &length : lengths) {
        length = kind.noise_m < 0.0
                     ? kPaperMetresPerCount * std::round(length / kPaperMetresPerCount)
                     : length + kind.noise_m * normal(random);
    }
    return lengths;
}

void judge(ForwardKinematics &kinematics, const LengthProblem &problem, const GripPose &truth,
           long at, Rates &rates) {
    ++rates.cases;
    const KinematicsResult result = kinematics.solve_cold(problem.lengths_m);
    const PolishResult branch = polish_pose(problem, truth);
    if (!usable(result.status) || !branch.converged) {
        ++rates.refused;
        return;
    }
    const Vec3 box(kPaperHalfExtent_m);
    bool rival = false;
    for (int pair = 0; pair < kRootPairCount; ++pair) {
        const PolishResult other =
            polish_pose(problem, test::closed_form_pose(box, problem.grip.pole_half_length_m,
                                                        problem.lengths_m, pair));
        const bool distinct = test::distance(other.pose, branch.pose) > kDistinctPose_m;
        const bool inside = std::fabs(other.pose.position_m.z) < box.z;
        rates.not_upright += pair == 0 && distinct ? 1 : 0;
        rival = rival || (other.converged && distinct && inside &&
                          other.residual_rms_m <= branch.residual_rms_m);
    }
    const bool flagged = result.status == Status::ambiguous_pose;
    const bool wrong = test::distance(result.pose, branch.pose) > kDistinctPose_m;
    rates.ambiguous += rival ? 1 : 0;
    rates.flagged += flagged ? 1 : 0;
    rates.wrong += wrong ? 1 : 0;
    rates.wrong_unflagged += wrong && !flagged ? 1 : 0;
    if (wrong && rates.first_wrong < 0) {
        rates.first_wrong = at;
    }
}

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 20000);
    const long seed = test::whole_option(argc, argv, "--seed", 1);
    if (cases <= 0) {
        std::fprintf(stderr, "--cases is %ld; give a positive number of cases.\n", cases);
        return 2;
    }
    const GripGeometry grip;
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    ForwardKinematics kinematics;
    if (!usable(kinematics.configure(frame, grip))) {
        return 1;
    }
    constexpr std::size_t kCount = std::size(kKinds);
    Rates rates[kCount];
    for (long i = 0; i < cases; ++i) {
        // Each case has its own generator, so that it replays alone; the noises take turns.
        test::Random random(static_cast<std::uint64_t>(seed) * 1000003ULL +
                            static_cast<std::uint64_t>(i));
        const Vec3 position(random.between(-0.2, 0.2), random.between(-0.2, 0.2),
                            random.between(-0.2, 0.2));
        const double turn = 60.0 * kDeg;
        const double x = random.between(-turn, turn);
        const double y = random.between(-turn, turn);
        const double z = random.between(-turn, turn);
        const double grasp = random.between(-45.0 * kDeg, 45.0 * kDeg);
        const GripPose truth = make_pose(grip, position, test::rotation_zyx(x, y, z), grasp);
        const auto k = static_cast<std::size_t>(i) % kCount;
        const StringArray lengths =
            with_errors(string_lengths(frame, grip, truth), kKinds[k], random);
        judge(kinematics, {frame, grip, lengths}, truth, i, rates[k]);
    }
    bool good = true;
    for (std::size_t k = 0; k < kCount; ++k) {
        const Rates &r = rates[k];
        const double share = 100.0 / static_cast<double>(r.cases > 0 ? r.cases : 1);
        // Two counts of the same size differ by chance: three standard deviations of the smaller one's.
        const double allowed =
            static_cast<double>(r.ambiguous) + 3.0 * std::sqrt(static_cast<double>(r.ambiguous));
        good = good && static_cast<double>(r.wrong) <= allowed;
        std::printf("%-7s cases %ld, refused %ld, not upright %.3f %%, another fits as well %.3f "
                    "%%, wrong branch %.3f %%, of it unflagged %.3f %%, flagged ambiguous %.2f %%, "
                    "first wrong case %ld\n",
                    kKinds[k].name, r.cases, r.refused, share * static_cast<double>(r.not_upright),
                    share * static_cast<double>(r.ambiguous), share * static_cast<double>(r.wrong),
                    share * static_cast<double>(r.wrong_unflagged),
                    share * static_cast<double>(r.flagged), r.first_wrong);
    }
    std::printf("seed %ld, cases %ld, %s\n", seed, cases, good ? "no failure" : "FAILED");
    return good ? 0 : 1;
}
