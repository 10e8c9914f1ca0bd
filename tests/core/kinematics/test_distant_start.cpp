// What 10^9 cases of stress_kinematics found: starts far away, next to singular poses, on another branch, too fast.
#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "core/kinematics/forward_kinematics.h"

using namespace spidar;

namespace {

struct Start {
    StringArray lengths_m;
    GripPose memory;
};

// stress_kinematics --cases 1 with --seed 1001 --first 7297417, --seed 1001 --first 82418928, --seed 1002 --first 6370927;
// and --seed 3001 --first 15040033, which ends next to a singular pose and used to creep along a valley.
const Start kStarts[] = {
    {{0.45123141156729918, 0.42576721920505212, 0.5083234355564632, 0.5223926039387875,
      0.27873265810207321, 0.31891467458640377, 0.4603776362220548, 0.45950016452928039},
     {{0.13420484819600681, -0.1257870096343342, -0.02000274980537603},
      {-0.019378640162446264, 0.033865498005976317, -0.0088088790581798138},
      {0.03596068407991123, 0.010800267437819646, 0.013790700626740877}}},
    {{0.73110765577695214, 0.46014375769335292, 0.76493996998655323, 0.51845760352134906,
      0.57134053923315198, 0.25725468728793094, 0.61571078455807904, 0.29953967600346026},
     {{-0.11078209585677708, -0.16697020153443584, -0.0034583305748754345},
      {0.0018628761883063131, 0.038648585277238676, -0.0101398495242805},
      {0.033138006301841466, -0.015201170793549129, -0.016455909116316385}}},
    {{0.30283184887789372, 0.1822785867886943, 0.49577660279231001, 0.43511235885741867,
      0.53992576470698594, 0.48019419338620589, 0.68008588864238206, 0.65548657098463414},
     {{-0.13688296467177086, -0.026370466299835638, 0.15701504533501315},
      {-0.0016916887961975846, 0.037842002426287116, 0.012849943244454395},
      {0.039147056586960979, -0.002393561623836628, -0.0078599505933670683}}},
    {{0.71130676943428417, 0.58529160372554789, 0.56245517201620221, 0.47816049846724529,
      0.51636704534208078, 0.41065152847848874, 0.3665553786070771, 0.11511917792339862},
     {{-0.0011966724876710244, -0.13667839269298554, 0.17437021278751125},
      {-0.015741535922627996, 0.034828952416160824, -0.011796106153702466},
      {0.034298085928191245, 0.012645855058782482, 0.016239570545266122}}},
};

// The paper's device, one update from that memory.
KinematicsResult update_from(const GripPose &memory, const StringArray &lengths_m) {
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry()) ==
            Status::ok);
    kinematics.set_last_pose(memory);
    return kinematics.update(lengths_m);
}

// The defining equation: these are the lengths of that pose.
void check_lengths(const GripPose &pose, const StringArray &lengths_m, double tolerance_m) {
    const StringArray back_m =
        string_lengths(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry(), pose);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(std::fabs(back_m[i] - lengths_m[i]) < tolerance_m);
    }
}

} // namespace

TEST_CASE("kinematics: a start far away that nearly ends within the bound on steps goes on once") {
    for (const Start &start : kStarts) {
        const KinematicsResult result = update_from(start.memory, start.lengths_m);
        REQUIRE(usable(result.status));
        check_lengths(result.pose, start.lengths_m, 1e-14);
    }
}

TEST_CASE("kinematics: a wrong branch that fits to a millimetre does not outweigh one that fits "
          "exactly") {
    // stress_kinematics --seed 4001 --first 918320623 --cases 1: samples were lost, and the last pose led 21 mm astray.
    const GripPose truth{{-0.08512193548038148, 0.059040958285072498, -0.20875841323538163},
                         {-0.022328622584302418, 0.033156852715252302, 0.001433782238293689},
                         {0.035893047871701007, 0.011572000579537053, 0.013333338556677178}};
    const GripPose memory{{-0.087051575207830342, 0.062800537682010771, -0.19830699134169191},
                          {-0.015665029556895589, 0.03458849702367231, 0.012579456372395428},
                          {0.032171987176451436, 0.013749644950968346, -0.019388411612108799}};
    const KinematicsResult result = update_from(
        memory, string_lengths(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry(), truth));
    REQUIRE(usable(result.status));
    CHECK(glm::distance(result.pose.position_m, truth.position_m) < 1e-12);
    CHECK(glm::distance(result.pose.r2_m, truth.r2_m) < 1e-12);
}

TEST_CASE("kinematics: a search ends at rounding also where an old factorisation converges by half "
          "only") {
    // stress_kinematics --seed 4001 --first 64325003 --cases 1: the pose was off by 9.6e-13 m and called exact.
    const StringArray lengths_m = {0.41066861746721434, 0.20531497756934447, 0.50525457663820561,
                                   0.36156818003222874, 0.48866383906364463, 0.41702947289885212,
                                   0.59675110953952237, 0.53665392839668913};
    const GripPose memory{{-0.14568287485965326, -0.0063254856045345809, 0.0075686324909342573},
                          {0.0048275822289544365, 0.035113201913341704, 0.018540698509376063},
                          {0.039436147053135681, 0.0020145189038736186, 0.0063821641462276646}};
    const KinematicsResult result = update_from(memory, lengths_m);
    REQUIRE(result.status == Status::ok);
    check_lengths(result.pose, lengths_m, 1e-15);
}

TEST_CASE(
    "kinematics: a tick that jumps by millimetres takes a third step, and is right to 10 nm") {
    // A small device, whose lengths bend most: stress_kinematics --seed 4001 --first 64247647 --cases 1, and movements
    // about it in every direction.
    GripGeometry grip;
    grip.pole_half_length_m = 0.011662705915820994;
    const FrameGeometry frame =
        make_box_frame(Vec3(0.092600166392353356, 0.068819865346002485, 0.069578241009043446));
    const GripPose start = make_pose(grip, Vec3(0.013, 0.028, 0.014), Mat3(1.0), 0.1);
    int third_steps = 0;
    for (int direction = 0; direction < 27; ++direction) {
        const Vec3 way(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
        ForwardKinematics kinematics;
        REQUIRE(kinematics.configure(frame, grip) == Status::ok);
        kinematics.set_last_pose(start);
        const double turn = 0.05;
        const Mat3 turned(std::cos(turn), std::sin(turn), 0, -std::sin(turn), std::cos(turn), 0, 0,
                          0, 1);
        const GripPose next = make_pose(grip, start.position_m + 2e-3 * way, turned, 0.15);
        const KinematicsResult result = kinematics.update(string_lengths(frame, grip, next));
        REQUIRE(usable(result.status));
        third_steps += result.steps == 3 && !result.cold_start ? 1 : 0;
        CHECK(glm::distance(result.pose.position_m, next.position_m) < 1e-8);
        CHECK(glm::distance(result.pose.r1_m, next.r1_m) < 1e-8);
        CHECK(glm::distance(result.pose.r2_m, next.r2_m) < 1e-8);
    }
    CHECK(third_steps > 9);
}
