// Who asks for what. The device renders one wrench and one set of contacts; a scene has several that ask: a hand, a
// script, another script. Each owner replaces only what it asked for itself, and the device gets the sum.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "device/contract/haptic_command.h"

namespace spidar {

class RequestOwners {
public:
    // Times are those of the snapshot (unit: s).
    void clear() noexcept { owners_.clear(); }
    // After its duration a wrench fades over this time, as the device's own does; a set of contacts older than the
    // second is forgotten, as the device fades it.
    void configure(double wrench_fade_s, double contacts_gone_s) noexcept {
        wrench_fade_s_ = wrench_fade_s;
        contacts_gone_s_ = contacts_gone_s;
    }

    // Checked before: finite, duration in range; device frame.
    void set_wrench(const std::string &owner, const Wrench &wrench, double duration_s,
                    double now_s);
    // The sum of all, full for the longest time that is left, into `command`.
    void write_wrench(HapticCommand &command, double now_s);
    // True while the sum changes by itself: one of several wrenches ends or fades.
    [[nodiscard]] bool wrench_changes(double now_s) const noexcept;

    // How many of the device's contacts the others leave to `owner`.
    [[nodiscard]] int free_contacts(const std::string &owner, double now_s) const noexcept;
    // At most free_contacts(owner) planes; each keeps its id's number of the device.
    void set_contacts(const std::string &owner, const ContactPlane *planes, int count,
                      double now_s);
    // The sets of all, moved on by their velocities to `now_s`.
    void write_contacts(HapticCommand &command, double now_s);
    // The owner's own id of a contact of the device; false when it is not one of its.
    [[nodiscard]] bool id_of(const std::string &owner, std::int32_t device_id,
                             std::int32_t &id) const noexcept;

    // "script: 2.0 N, SpidarGHand: 1.1 N": what of the wrenches is asked for now.
    [[nodiscard]] std::string describe_wrenches(double now_s) const;

private:
    struct Numbered {
        std::int32_t id = 0;        // the owner's
        std::int32_t device_id = 0; // of all owners
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
        // Of this set and the one before: impulses come back a little later.
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
