// Ownership of a device within this process: a second owner of the same device is refused.
#pragma once

#include <string>

namespace spidar {

// Devices with an empty name are private and always granted.
class DeviceClaim {
public:
    DeviceClaim() = default;
    ~DeviceClaim();
    DeviceClaim(const DeviceClaim &) = delete;
    DeviceClaim &operator=(const DeviceClaim &) = delete;

    // Returns false when another claim owns the device; owner_of(name) then returns its owner. A
    // new claim ends the one that this object held. `owner` is a name for messages.
    bool take(const std::string &name, const std::string &owner);
    void release() noexcept;
    // Returns the owner, or an empty string.
    [[nodiscard]] static std::string owner_of(const std::string &name);

private:
    std::string name_;
};

} // namespace spidar
