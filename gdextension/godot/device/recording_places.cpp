#include "godot/device/recording_places.h"

#include <filesystem>
#include <map>
#include <system_error>

namespace spidar {

namespace {

// Main thread only.
std::map<std::string, std::string> &places() {
    static std::map<std::string, std::string> all;
    return all;
}

// Returns one name per file, whatever links and dots lead to it.
std::string plain(const std::string &path) {
    std::error_code error;
    const std::filesystem::path place =
        std::filesystem::weakly_canonical(std::filesystem::path(path), error);
    return error ? path : place.string();
}

} // namespace

RecordingPlace::~RecordingPlace() {
    release();
}

bool RecordingPlace::take(const std::string &path, const std::string &owner) {
    const std::string place = plain(path);
    if (!places().emplace(place, owner).second) {
        return false;
    }
    release();
    path_ = place;
    return true;
}

void RecordingPlace::release() noexcept {
    if (!path_.empty()) {
        places().erase(path_);
        path_.clear();
    }
}

std::string RecordingPlace::owner_of(const std::string &path) {
    const auto found = places().find(plain(path));
    return found == places().end() ? std::string() : found->second;
}

} // namespace spidar
