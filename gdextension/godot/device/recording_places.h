// Reserves a file for one recording of this process, since a second recording into it would destroy
// the first.
#pragma once

#include <string>

namespace spidar {

class RecordingPlace {
public:
    RecordingPlace() = default;
    ~RecordingPlace();
    RecordingPlace(const RecordingPlace &) = delete;
    RecordingPlace &operator=(const RecordingPlace &) = delete;

    // Reserves the file and releases the one reserved before. Returns false when the file is
    // already reserved; owner_of(path) then returns its owner.
    bool take(const std::string &path, const std::string &owner);
    void release() noexcept;
    [[nodiscard]] static std::string owner_of(const std::string &path);

private:
    std::string path_;
};

} // namespace spidar
