// One writer a file, within this process: a second recording into a file that grows would destroy the first.
#pragma once

#include <string>

namespace spidar {

class RecordingPlace {
public:
    RecordingPlace() = default;
    ~RecordingPlace();
    RecordingPlace(const RecordingPlace &) = delete;
    RecordingPlace &operator=(const RecordingPlace &) = delete;

    // False when another recording of this process writes into that file; owner_of(path) says whose.
    bool take(const std::string &path, const std::string &owner);
    void release() noexcept;
    [[nodiscard]] static std::string owner_of(const std::string &path);

private:
    std::string path_;
};

} // namespace spidar
