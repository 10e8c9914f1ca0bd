// The head of a recording: what was recorded, by which build and with which settings. It is text,
// one field per line, so that any tool and other versions can read it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "device/settings/servo_settings.h"

namespace spidar {

// Version of chunks and cycles. Files of a later format are refused.
inline constexpr std::uint32_t kRecordingFormat = 3;

struct RecordingInfo {
    std::string version;     // of spidar_g
    std::string started_utc; // ISO 8601
    std::uint64_t build = 0; // build_identity()
    std::uint64_t command_schema = 0;
    std::uint64_t command_words = 0;
    std::uint64_t reading_words = 0; // reading_fields.h
    std::uint64_t touch_words = 0;   // touch_words.h
    std::uint64_t state_bytes = 0;   // size of the step's memory
    ServoSettings settings;
};

// Returns the head that this build writes for a recording with these settings.
[[nodiscard]] RecordingInfo describe_recording(const ServoSettings &settings);

[[nodiscard]] std::string to_text(const RecordingInfo &info);

// Reads a head. Returns an empty string, or a text with the reason of a failure. Unknown fields are
// ignored. Missing fields keep their defaults; only the format must be there.
[[nodiscard]] std::string read_text(std::string_view text, RecordingInfo &info);

// Returns an empty string when this build can replay bit for bit, else a reason with remedy.
[[nodiscard]] std::string why_no_replay(const RecordingInfo &info);

} // namespace spidar
