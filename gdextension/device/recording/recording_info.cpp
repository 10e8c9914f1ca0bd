#include "device/recording/recording_info.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <limits>

#include "core/base/simd_level.h"
#include "device/recording/build_identity.h"
#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/reading_fields.h"
#include "device/recording/codec/settings_fields.h"
#include "device/recording/codec/touch_words.h"
#include "device/step/servo_step.h"

namespace spidar {

namespace {

constexpr std::string_view kTitle = "spidar_g recording";
constexpr std::string_view kSettings = "settings.";
constexpr std::uint64_t kMostWords = 2'000; // five times a command's words; each cycle copies them
constexpr std::uint64_t kMostStateBytes = 1'000'000;

std::string now_utc() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
#ifdef _WIN32
    gmtime_s(&parts, &now);
#else
    gmtime_r(&now, &parts);
#endif
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

// Doubles are written in hexadecimal: exact and independent of the locale.
template <typename T>
std::string text_of(T value) {
    std::array<char, 40> text{};
    std::to_chars_result end{};
    if constexpr (std::is_same_v<T, double>) {
        end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
    } else {
        end =
            std::to_chars(text.data(), text.data() + text.size(), static_cast<std::int64_t>(value));
    }
    return {text.data(), end.ptr};
}

template <typename T>
bool value_of(std::string_view text, T &value) noexcept {
    const char *const end = text.data() + text.size();
    if constexpr (std::is_same_v<T, double>) {
        const auto read = std::from_chars(text.data(), end, value, std::chars_format::hex);
        return read.ec == std::errc() && read.ptr == end;
    } else {
        std::int64_t whole = 0;
        const auto read = std::from_chars(text.data(), end, whole);
        value = static_cast<T>(whole);
        return read.ec == std::errc() && read.ptr == end &&
               static_cast<std::int64_t>(value) == whole;
    }
}

void line(std::string &text, std::string_view name, std::string_view value) {
    text.append(name).append("=").append(value).append("\n");
}

std::string hex(std::uint64_t value) {
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

bool from_hex(std::string_view text, std::uint64_t &value) noexcept {
    constexpr int kBase = 16;
    const char *const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value, kBase);
    return read.ec == std::errc() && read.ptr == end;
}

bool read_setting(std::string_view name, std::string_view value, ServoSettings &settings) {
    bool good = true;
    for_each_field(settings, [&](std::string_view field, int index, auto &place) {
        if (name.size() > field.size() && name.substr(0, field.size()) == field &&
            name.substr(field.size()) == "." + std::to_string(index)) {
            good = value_of(value, place);
        }
    });
    return good;
}

bool read_field(std::string_view name, std::string_view value, RecordingInfo &info) {
    if (name == "version") {
        info.version = value;
    } else if (name == "started_utc") {
        info.started_utc = value;
    } else if (name == "build") {
        return from_hex(value, info.build);
    } else if (name == "command_schema") {
        return from_hex(value, info.command_schema);
    } else if (name == "command_words") {
        return value_of(value, info.command_words) && info.command_words <= kMostWords;
    } else if (name == "reading_words") {
        return value_of(value, info.reading_words) && info.reading_words <= kMostWords;
    } else if (name == "touch_words") {
        return value_of(value, info.touch_words) && info.touch_words <= kMostWords;
    } else if (name == "state_bytes") {
        return value_of(value, info.state_bytes) && info.state_bytes <= kMostStateBytes;
    } else if (name.substr(0, kSettings.size()) == kSettings) {
        return read_setting(name.substr(kSettings.size()), value, info.settings);
    }
    return true;
}

} // namespace

RecordingInfo describe_recording(const ServoSettings &settings) {
    RecordingInfo info;
    info.version = build_version();
    info.started_utc = now_utc();
    info.build = build_identity();
    info.command_schema = schema_of(HapticCommand{});
    info.command_words = count_fields(HapticCommand{});
    info.reading_words = count_fields(DeviceReading{});
    info.touch_words = count_touch_words();
    info.state_bytes = sizeof(ServoStep);
    info.settings = settings;
    return info;
}

std::string to_text(const RecordingInfo &info) {
    std::string text(kTitle);
    text.append("\n");
    line(text, "format", text_of(kRecordingFormat));
    line(text, "version", info.version);
    line(text, "started_utc", info.started_utc);
    line(text, "build", hex(info.build));
    line(text, "command_schema", hex(info.command_schema));
    line(text, "command_words", text_of(info.command_words));
    line(text, "reading_words", text_of(info.reading_words));
    line(text, "touch_words", text_of(info.touch_words));
    line(text, "state_bytes", text_of(info.state_bytes));
    for_each_field(info.settings, [&text](std::string_view name, int index, auto value) {
        line(text, std::string(kSettings).append(name) + "." + std::to_string(index),
             text_of(value));
    });
    return text;
}

std::string read_text(std::string_view text, RecordingInfo &info) {
    if (text.substr(0, kTitle.size()) != kTitle) {
        return "This is not a recording of spidar_g; choose another file.";
    }
    bool known_format = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view entry = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t equals = entry.find('=');
        if (equals == std::string_view::npos) {
            continue;
        }
        const std::string_view name = entry.substr(0, equals);
        const std::string_view value = entry.substr(equals + 1);
        if (name == "format") {
            std::uint32_t format = 0;
            if (!value_of(value, format) || format == 0 || format > kRecordingFormat) {
                return "The recording has format " + std::string(value) +
                       "; this version of spidar_g reads formats 1 to " +
                       std::to_string(kRecordingFormat) + ". Use the version that made it.";
            }
            known_format = true;
        } else if (!read_field(name, value, info)) {
            return "The head of the recording holds \"" + std::string(entry) +
                   "\", which is not valid. The file is damaged.";
        }
    }
    return known_format ? std::string()
                        : std::string("The head of the recording names no format. "
                                      "The file is damaged.");
}

std::string why_no_replay(const RecordingInfo &info) {
    if (info.build != build_identity()) {
        return "The recording was made by another build of spidar_g (version " + info.version +
               ", build " + hex(info.build) + "; this is " + build_version() + ", build " +
               hex(build_identity()) +
               "), so it replays the poses only and does not repeat the results bit by bit. Replay "
               "it with the build that made it.";
    }
    if (info.command_schema != schema_of(HapticCommand{}) ||
        info.command_words != count_fields(HapticCommand{}) ||
        info.touch_words != count_touch_words() || info.state_bytes != sizeof(ServoStep)) {
        return "The recording holds commands or memory in another form than this build, so it "
               "replays the poses only and does not repeat the results bit by bit. Replay it with "
               "the build that made it.";
    }
    const SimdLevel level = info.settings.tension.simd;
    if (!supports(level)) {
        return "The recording was made at vector level " + std::to_string(static_cast<int>(level)) +
               " (" + describe(level) +
               "), which this processor or this version of spidar_g does not support, so it "
               "replays the poses only and does not repeat the results bit by bit. Replay it where "
               "that level is supported.";
    }
    return {};
}

} // namespace spidar
