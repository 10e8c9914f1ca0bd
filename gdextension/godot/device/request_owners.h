// Requests by owner. The device renders one wrench and one set of contacts, but a hand and several
// scripts may request some. Each owner replaces only its own requests; the device gets the sum.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "device/contract/haptic_command.h"

namespace spidar {

class RequestOwners {
public:
    // Forgets all owners. All times of this class are snapshot times (unit: s).
    void clear() noexcept { owners_.clear(); }
    // wrench_fade_s: time over which a wrench fades after its duration. contacts_gone_s: age at
    // which contacts are forgotten. Both equal those of the device.
    void configure(double wrench_fade_s, double contacts_gone_s) noexcept {
        wrench_fade_s_ = wrench_fade_s;
        contacts_gone_s_ = contacts_gone_s;
    }

    // Requires finite values and a duration in range; device frame.
    void set_wrench(const std::string &owner, const Wrench &wrench, double duration_s,
                    double now_s);
    // Writes the sum of all wrenches to `command`, at full strength for the longest time left.
    void write_wrench(HapticCommand &command, double now_s);
    // True while the sum changes by itself, because one of several wrenches ends or fades.
    [[nodiscard]] bool wrench_changes(double now_s) const noexcept;

    // Returns how many contacts of the device the other owners leave to `owner`.
    [[nodiscard]] int free_contacts(const std::string &owner, double now_s) const noexcept;
    // Requires at most free_contacts(owner) planes. Each keeps the device id of its own id.
    void set_contacts(const std::string &owner, const ContactPlane *planes, int count,
                      double now_s);
    // Writes the contacts of all owners into `command`, extrapolated to now_s by their velocities.
    void write_contacts(HapticCommand &command, double now_s);
    // Finds the owner's id of a device contact. Returns false when the contact is not the owner's.
    [[nodiscard]] bool id_of(const std::string &owner, std::int32_t device_id,
                             std::int32_t &id) const noexcept;

    // Returns the present wrenches: "script: 2.0 N, SpidarGHand: 1.1 N".
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
        // Ids of this set and of the last one, since impulses come back a little later.
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
