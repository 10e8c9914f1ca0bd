// One owner a device, within this process: a second node on the same device is refused.
#pragma once

#include <string>

namespace spidar {

// Empty names are private devices: always granted.
class DeviceClaim {
public:
    DeviceClaim() = default;
    ~DeviceClaim();
    DeviceClaim(const DeviceClaim &) = delete;
    DeviceClaim &operator=(const DeviceClaim &) = delete;

    // False when somebody else owns it; owner_of(name) tells who. `owner` is for messages.
    bool take(const std::string &name, const std::string &owner);
    void release() noexcept;
    [[nodiscard]] static std::string owner_of(const std::string &name);

private:
    std::string name_;
};

} // namespace spidar
