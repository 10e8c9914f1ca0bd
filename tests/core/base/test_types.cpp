// The paper's wrench and the game's, and the gains of each, cannot be mixed: g is twice the grasp torque.
#include <doctest/doctest.h>

#include <concepts>
#include <type_traits>

#include "core/base/types.h"
#include "device/contract/haptic_command.h"

using namespace spidar;

namespace {

template <class From, class To>
concept BecomesWithoutAWord = std::convertible_to<From, To> || std::is_assignable_v<To &, From> ||
    std::constructible_from<To, From>;

} // namespace

TEST_CASE("types: a row of one meaning does not become one of another") {
    static_assert(!BecomesWithoutAWord<PaperWrench, Wrench>);
    static_assert(!BecomesWithoutAWord<Wrench, PaperWrench>);
    static_assert(!BecomesWithoutAWord<PaperWeights, DofGains>);
    static_assert(!BecomesWithoutAWord<DofGains, PaperWeights>);
    static_assert(!BecomesWithoutAWord<PaperWrench, DofGains>);
    static_assert(!BecomesWithoutAWord<PaperWeights, PaperWrench>);
    static_assert(!BecomesWithoutAWord<PaperTwist, PaperWrench>);
    static_assert(!BecomesWithoutAWord<Twist, PaperTwist>);
}

TEST_CASE("types: the paper's g is twice the grasp torque, and all else is the same") {
    const Wrench wrench{Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3), 0.05};
    const PaperWrench q = to_paper(wrench);
    CHECK(q == PaperWrench{1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.1});
    const Wrench back = from_paper(q);
    CHECK(back.force_n == wrench.force_n);
    CHECK(back.moment_nm == wrench.moment_nm);
    CHECK(back.grasp_torque_nm == wrench.grasp_torque_nm);
}
