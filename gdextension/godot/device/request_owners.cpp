#include "godot/device/request_owners.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include <glm/geometric.hpp>

namespace spidar {

RequestOwners::Owner &RequestOwners::owner_named(const std::string &name) {
    for (Owner &owner : owners_) {
        if (owner.name == name) {
            return owner;
        }
    }
    owners_.emplace_back();
    owners_.back().name = name;
    return owners_.back();
}

// Returns 1 for the duration of a wrench, then a fade to 0.
double RequestOwners::share(const Owner &owner, double now_s) const noexcept {
    if (!owner.has_wrench) {
        return 0.0;
    }
    const double past_s = now_s - owner.wrench_ends_s;
    if (past_s <= 0.0) {
        return 1.0;
    }
    return wrench_fade_s_ > 0.0 ? std::max(0.0, 1.0 - past_s / wrench_fade_s_) : 0.0;
}

void RequestOwners::set_wrench(const std::string &name, const Wrench &wrench, double duration_s,
                               double now_s) {
    Owner &owner = owner_named(name);
    owner.wrench = wrench;
    owner.wrench_ends_s = now_s + duration_s;
    owner.wrench_set_s = now_s;
    owner.wrench_duration_s = duration_s;
    owner.has_wrench = true;
}

void RequestOwners::write_wrench(HapticCommand &command, double now_s) {
    Wrench sum;
    double left_s = 0.0;
    for (Owner &owner : owners_) {
        const double part = share(owner, now_s);
        owner.has_wrench = part > 0.0;
        if (!owner.has_wrench) {
            continue;
        }
        sum.force_n += part * owner.wrench.force_n;
        sum.moment_nm += part * owner.wrench.moment_nm;
        sum.grasp_torque_nm += part * owner.wrench.grasp_torque_nm;
        const bool is_new = owner.wrench_set_s == now_s; // a new wrench has no rounding error
        left_s = std::max(left_s, is_new ? owner.wrench_duration_s : owner.wrench_ends_s - now_s);
    }
    command.wrench = sum;
    command.wrench_duration_s = std::clamp(left_s, 0.0, kMaxWrenchDuration_s);
    ++command.wrench_sequence;
}

bool RequestOwners::wrench_changes(double now_s) const noexcept {
    int acting = 0;
    bool over = false;
    for (const Owner &owner : owners_) {
        acting += owner.has_wrench ? 1 : 0;
        over = over || (owner.has_wrench && owner.wrench_ends_s < now_s);
    }
    return acting > 1 && over; // the device fades a single wrench by itself
}

bool RequestOwners::is_fresh(const Owner &owner, double now_s) const noexcept {
    return now_s - owner.planes_at_s <= contacts_gone_s_;
}

int RequestOwners::free_contacts(const std::string &name, double now_s) const noexcept {
    int free = kMaxContacts;
    for (const Owner &owner : owners_) {
        if (owner.name != name && is_fresh(owner, now_s)) {
            free -= owner.plane_count;
        }
    }
    return free;
}

void RequestOwners::set_contacts(const std::string &name, const ContactPlane *planes, int count,
                                 double now_s) {
    Owner &owner = owner_named(name);
    std::vector<Numbered> numbers;
    for (int i = 0; i < count; ++i) {
        const std::int32_t id = planes[i].id;
        const auto known = std::find_if(owner.numbers.begin(), owner.numbers.end(),
                                        [id](const Numbered &number) { return number.id == id; });
        Numbered number{id, 0};
        if (known != owner.numbers.end()) {
            number = *known;
            owner.numbers.erase(known);
        } else {
            number.device_id = next_device_id_;
            constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::max();
            next_device_id_ = next_device_id_ == kLast ? 1 : next_device_id_ + 1;
        }
        numbers.push_back(number);
        const auto place = static_cast<std::size_t>(i);
        owner.planes[place] = planes[i];
        owner.planes[place].id = number.device_id;
    }
    owner.plane_count = count;
    owner.planes_at_s = now_s;
    // Ids of the previous set stay known for one more set.
    constexpr std::size_t kMostNumbers = 2 * kMaxContacts;
    numbers.insert(numbers.end(), owner.numbers.begin(), owner.numbers.end());
    numbers.resize(std::min(numbers.size(), kMostNumbers));
    owner.numbers = std::move(numbers);
}

void RequestOwners::write_contacts(HapticCommand &command, double now_s) {
    command.contact_count = 0;
    for (Owner &owner : owners_) {
        if (!is_fresh(owner, now_s)) {
            owner.plane_count = 0;
        }
        const double age_s = now_s - owner.planes_at_s;
        for (int i = 0; i < owner.plane_count && command.contact_count < kMaxContacts; ++i) {
            ContactPlane plane = owner.planes[static_cast<std::size_t>(i)];
            plane.offset_m += age_s * glm::dot(plane.normal, plane.velocity_m_s);
            command.contacts[static_cast<std::size_t>(command.contact_count)] = plane;
            ++command.contact_count;
        }
    }
    command.contacts_state_time_s = now_s;
    ++command.contacts_sequence;
}

bool RequestOwners::id_of(const std::string &name, std::int32_t device_id,
                          std::int32_t &id) const noexcept {
    for (const Owner &owner : owners_) {
        if (owner.name != name) {
            continue;
        }
        for (const Numbered &number : owner.numbers) {
            if (number.device_id == device_id) {
                id = number.id;
                return true;
            }
        }
    }
    return false;
}

std::string RequestOwners::describe_wrenches(double now_s) const {
    std::string text;
    for (const Owner &owner : owners_) {
        if (share(owner, now_s) <= 0.0) {
            continue;
        }
        std::array<char, 96> values{};
        std::snprintf(values.data(), values.size(), " requests %.2f N, %.3f N m, grasp %.3f N m",
                      glm::length(owner.wrench.force_n), glm::length(owner.wrench.moment_nm),
                      owner.wrench.grasp_torque_nm);
        text += text.empty() ? "" : "; ";
        text += (owner.name.empty() ? std::string("a script (request_wrench)") : owner.name) +
                values.data();
    }
    return text;
}

} // namespace spidar
