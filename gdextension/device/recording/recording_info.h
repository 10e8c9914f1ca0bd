// The head of a recording: what was recorded, by which build, with which settings. Kept as lines of text, so that it can
// be read with any tool, and by versions that know other fields.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "device/settings/servo_settings.h"

namespace spidar {

// Of the file's chunks and of the cycles in them. A file of a later format is refused.
inline constexpr std::uint32_t kRecordingFormat = 3;

struct RecordingInfo {
    std::string version;     // of spidar_g
    std::string started_utc; // ISO 8601
    std::uint64_t build = 0; // build_identity()
    std::uint64_t command_schema = 0;
    std::uint64_t command_words = 0;
    std::uint64_t reading_words = 0; // reading_fields.h
    std::uint64_t touch_words = 0;   // touch_words.h
    std::uint64_t state_bytes = 0;   // of the step's memory
    ServoSettings settings;
};

// What this build, now, would write about a recording with these settings.
[[nodiscard]] RecordingInfo describe_recording(const ServoSettings &settings);

[[nodiscard]] std::string to_text(const RecordingInfo &info);

// Empty when `text` is the head of a recording; else one sentence. Lines of unknown fields are passed over, and fields
// without a line keep their defaults.
[[nodiscard]] std::string read_text(std::string_view text, RecordingInfo &info);

// Empty when this build replays such a recording to the bit; else one sentence saying why not, and what to do.
[[nodiscard]] std::string why_no_replay(const RecordingInfo &info);

} // namespace spidar
