// Replaces contact ids in a replay. A recorded snapshot identifies contacts by the ids of the
// recorded game, but a game that runs again assigns new ids.
#pragma once

#include <array>
#include <cstdint>

#include "device/contract/haptic_command.h"
#include "device/contract/servo_snapshot.h"

namespace spidar {

class ReplayContacts {
public:
    // Called whenever the running game has requested a set of contacts.
    void note(const HapticCommand &command) noexcept {
        Set &set = sets_[command.contacts_sequence % kSets];
        set.sequence = command.contacts_sequence;
        set.count = command.contact_count;
        for (std::size_t i = 0; i < set.ids.size(); ++i) {
            set.ids[i] = command.contacts[i].id;
        }
    }

    // Gives the contacts in `snapshot` the ids of the running game's set that is `sets_ago` sets
    // older than newest_sequence. This assumes that the running game has requested the same
    // contacts in the same order. sets_ago: age of the snapshot's set when the recorded game read
    // it. Changes nothing if that set is forgotten or has another number of contacts.
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
    // Number of remembered sets. Normally sets_ago is 0 or 1.
    static constexpr std::size_t kSets = 32;
    struct Set {
        std::uint64_t sequence = 0;
        int count = 0;
        std::array<std::int32_t, kMaxContacts> ids{};
    };
    std::array<Set, kSets> sets_{};
};

} // namespace spidar
