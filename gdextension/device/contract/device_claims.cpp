#include "device/contract/device_claims.h"

#include <map>
#include <mutex>
#include <utility>

namespace spidar {

namespace {

struct Claims {
    std::mutex mutex;
    std::map<std::string, std::string> owners; // device name -> owner
};

// Never destroyed: a static object may release its claim after main().
Claims &claims() {
    static Claims *const kept = new Claims;
    return *kept;
}

} // namespace

DeviceClaim::~DeviceClaim() {
    release();
}

bool DeviceClaim::take(const std::string &name, const std::string &owner) {
    if (!name_.empty() && name == name_) {
        return true;
    }
    if (!name.empty()) {
        Claims &all = claims();
        const std::lock_guard<std::mutex> lock(all.mutex);
        if (!all.owners.emplace(name, owner).second) {
            return false; // a claim that is already held stays
        }
    }
    std::string taken = name;
    release();
    name_ = std::move(taken);
    return true;
}

void DeviceClaim::release() noexcept {
    if (name_.empty()) {
        return;
    }
    Claims &all = claims();
    const std::lock_guard<std::mutex> lock(all.mutex);
    all.owners.erase(name_);
    name_.clear();
}

std::string DeviceClaim::owner_of(const std::string &name) {
    Claims &all = claims();
    const std::lock_guard<std::mutex> lock(all.mutex);
    const auto found = all.owners.find(name);
    return found == all.owners.end() ? std::string() : found->second;
}

} // namespace spidar
