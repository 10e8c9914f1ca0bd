// One recording per file within this process: a second one would destroy the first.
#pragma once

#include <string>

namespace spidar {

class RecordingPlace {
public:
    RecordingPlace() = default;
    ~RecordingPlace();
    RecordingPlace(const RecordingPlace &) = delete;
    RecordingPlace &operator=(const RecordingPlace &) = delete;

    // Returns false when another recording of this process writes to the file; owner_of(path) then
    // names its owner.
    bool take(const std::string &path, const std::string &owner);
    void release() noexcept;
    [[nodiscard]] static std::string owner_of(const std::string &path);

private:
    std::string path_;
};

} // namespace spidar
