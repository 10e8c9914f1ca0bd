// Contact ids in a replay. A snapshot identifies contacts by the ids of the recorded game, but a
// game that runs again assigns new ids. The reports of a replay get the ids of the running game.
#pragma once

#include <array>
#include <cstdint>

#include "device/contract/haptic_command.h"
#include "device/contract/servo_snapshot.h"

namespace spidar {

class ReplayContacts {
public:
    // Called after each set of contacts that the game requests.
    void note(const HapticCommand &command) noexcept {
        Set &set = sets_[command.contacts_sequence % kSets];
        set.sequence = command.contacts_sequence;
        set.count = command.contact_count;
        for (std::size_t i = 0; i < set.ids.size(); ++i) {
            set.ids[i] = command.contacts[i].id;
        }
    }

    // The snapshot belongs to the set that was `sets_ago` sets old when the recorded game read it.
    // A scene that repeats has requested the same contacts so many sets ago, in the same order.
    void renumber(std::uint64_t newest_sequence, std::uint64_t sets_ago,
                  ServoSnapshot &snapshot) const noexcept {
        const std::uint64_t sequence = newest_sequence - sets_ago;
        const Set &set = sets_[sequence % kSets];
        if (set.sequence != sequence || set.count != snapshot.contact_count) {
            return; // another scene, or too long ago
        }
        for (int i = 0; i < set.count; ++i) {
            const auto place = static_cast<std::size_t>(i);
            snapshot.contacts[place].id = set.ids[place];
        }
    }

private:
    // Number of remembered sets. A game reads the newest cycle, whose contacts belong to its last
    // tick or the one before.
    static constexpr std::size_t kSets = 32;
    struct Set {
        std::uint64_t sequence = 0;
        int count = 0;
        std::array<std::int32_t, kMaxContacts> ids{};
    };
    std::array<Set, kSets> sets_{};
};

} // namespace spidar
