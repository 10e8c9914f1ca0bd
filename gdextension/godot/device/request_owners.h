// Keeps the requests of each owner (a hand or a script). The device renders one wrench and one set
// of contacts, but several owners may request some. An owner replaces only its own requests. The
// device gets the sum of all wrenches and the contacts of all owners.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "device/contract/haptic_command.h"

namespace spidar {

class RequestOwners {
public:
    // Forgets all owners. All times in this class are ServoSnapshot::time_s (unit: s).
    void clear() noexcept { owners_.clear(); }
    // wrench_fade_s: time in which a wrench fades to zero after its duration. contacts_gone_s: age
    // after which contacts are forgotten. Pass the values of the device's SafetySettings.
    void configure(double wrench_fade_s, double contacts_gone_s) noexcept {
        wrench_fade_s_ = wrench_fade_s;
        contacts_gone_s_ = contacts_gone_s;
    }

    // Replaces the owner's wrench (device frame). The caller must have checked that all values are
    // finite and the duration is in range.
    void set_wrench(const std::string &owner, const Wrench &wrench, double duration_s,
                    double now_s);
    // Writes the sum of all wrenches to `command`. Its duration is the longest time that one of
    // them still has.
    void write_wrench(HapticCommand &command, double now_s);
    // True while write_wrench() must be called again, because one of several wrenches fades.
    [[nodiscard]] bool wrench_changes(double now_s) const noexcept;

    // Returns how many contacts `owner` may request: kMaxContacts minus those of all other owners.
    [[nodiscard]] int free_contacts(const std::string &owner, double now_s) const noexcept;
    // Replaces the owner's contacts. Requires at most free_contacts(owner) planes. A plane whose id
    // was in the owner's last set keeps its device id.
    void set_contacts(const std::string &owner, const ContactPlane *planes, int count,
                      double now_s);
    // Writes the contacts of all owners to `command`, extrapolated to now_s by their velocities.
    void write_contacts(HapticCommand &command, double now_s);
    // Sets `id` to the id that the owner uses for a contact of the device. Returns false when the
    // contact is not the owner's.
    [[nodiscard]] bool id_of(const std::string &owner, std::int32_t device_id,
                             std::int32_t &id) const noexcept;

    // Returns a text on the present wrenches: "Hand requests 2.00 N, 0.010 N m, grasp 0.000 N m",
    // separated by "; ".
    [[nodiscard]] std::string describe_wrenches(double now_s) const;

private:
    struct Numbered {
        std::int32_t id = 0;        // id of the owner
        std::int32_t device_id = 0; // unique among all owners
    };
    struct Owner {
        std::string name;
        Wrench wrench;
        double wrench_ends_s = 0.0;
        double wrench_set_s = 0.0;
        double wrench_duration_s = 0.0;
        bool has_wrench = false;
        std::array<ContactPlane, kMaxContacts> planes{};
        int plane_count = 0;
        double planes_at_s = 0.0;
        // Ids of this set and of earlier ones, since the device reports impulses a little later.
        std::vector<Numbered> numbers;
    };
    [[nodiscard]] Owner &owner_named(const std::string &name);
    [[nodiscard]] double share(const Owner &owner, double now_s) const noexcept;
    [[nodiscard]] bool is_fresh(const Owner &owner, double now_s) const noexcept;

    std::vector<Owner> owners_;
    std::int32_t next_device_id_ = 1;
    double wrench_fade_s_ = 0.0;
    double contacts_gone_s_ = 0.0;
};

} // namespace spidar
