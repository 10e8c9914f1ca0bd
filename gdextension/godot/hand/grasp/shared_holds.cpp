#include "godot/hand/grasp/shared_holds.h"

#include <algorithm>
#include <unordered_map>

#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "godot/base/type_conversions.h"

namespace spidar {

namespace {

std::unordered_map<std::uint64_t, std::vector<SharedHold>> &all_holds() {
    static std::unordered_map<std::uint64_t, std::vector<SharedHold>> holds;
    return holds;
}

} // namespace

void note_hold(std::uint64_t body, const SharedHold &hold) {
    std::vector<SharedHold> &holds = all_holds()[body];
    const auto mine = std::ranges::find(holds, hold.hand, &SharedHold::hand);
    if (mine != holds.end()) {
        *mine = hold;
    } else {
        holds.push_back(hold);
    }
}

void forget_hold(std::uint64_t body, std::uint64_t hand) {
    const auto found = all_holds().find(body);
    if (found == all_holds().end()) {
        return;
    }
    std::erase_if(found->second, [hand](const SharedHold &one) { return one.hand == hand; });
    if (found->second.empty()) {
        all_holds().erase(found);
    }
}

std::vector<SharedHold> other_holds(std::uint64_t body, std::uint64_t hand) {
    const auto found = all_holds().find(body);
    std::vector<SharedHold> others =
        found != all_holds().end() ? found->second : std::vector<SharedHold>();
    std::erase_if(others, [hand](const SharedHold &one) { return one.hand == hand; });
    return others;
}

godot::Transform3D shared_place(const godot::Transform3D &mine,
                                const std::vector<SharedHold> &others) {
    Vec3 origin = to_core(mine.origin);
    Mat3 turn = to_core(mine.basis.orthonormalized());
    double count = 1.0;
    for (const SharedHold &other : others) {
        count += 1.0;
        const Mat3 its_turn = to_core(other.body.basis.orthonormalized());
        origin += (to_core(other.body.origin) - origin) / count;
        turn = rotation_exp(rotation_log(its_turn * glm::transpose(turn)) / count) * turn;
    }
    return others.empty() ? mine : godot::Transform3D(to_godot(turn), to_godot(origin));
}

} // namespace spidar
