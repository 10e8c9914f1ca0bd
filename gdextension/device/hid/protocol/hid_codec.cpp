#include "device/hid/protocol/hid_codec.h"

#include <algorithm>

#include "device/hid/protocol/crc16.h"
#include "device/hid/protocol/report_sequence.h"

namespace spidar {

namespace {

// "SPDG" and "ZERO" in ASCII: a feature report of something else does not pass for these.
constexpr std::uint32_t kCapabilitiesMagic = 0x47445053;
constexpr std::uint32_t kZeroMagic = 0x4F52455A;
constexpr std::size_t kCrcSize = 2;
// The capabilities alone are sealed with this in every version, so that a host can read which version a device speaks.
constexpr std::uint16_t kCapabilitiesSeed = 0;

// Writes fields one after another, little-endian. seal() puts the CRC in the last two bytes, high byte first: only
// then is a burst of wrong bits that reaches into the CRC one that the CRC is sure to find.
template <std::size_t size>
class Writer {
public:
    explicit Writer(HidReportId id) noexcept { put(static_cast<std::uint8_t>(id)); }

    template <typename Integer>
    void put(Integer value) noexcept {
        const auto bits = static_cast<std::uint32_t>(value);
        for (std::size_t i = 0; i < sizeof(Integer); ++i) {
            bytes_[at_++] = static_cast<std::uint8_t>(bits >> (8U * i));
        }
    }
    template <typename Integer, std::size_t count>
    void put(const std::array<Integer, count> &values) noexcept {
        for (const Integer value : values) {
            put(value);
        }
    }

    [[nodiscard]] std::array<std::uint8_t, size>
    seal(std::uint16_t seed = kHidProtocolVersion) noexcept {
        const std::uint16_t crc = crc16(ReportBytes(bytes_).first(size - kCrcSize), seed);
        bytes_[size - 2] = static_cast<std::uint8_t>(crc >> 8U);
        bytes_[size - 1] = static_cast<std::uint8_t>(crc);
        return bytes_;
    }

private:
    std::array<std::uint8_t, size> bytes_{};
    std::size_t at_ = 0;
};

// Reads them back. Only over bytes whose length has been checked.
class Reader {
public:
    explicit Reader(ReportBytes bytes) noexcept : bytes_(bytes) {}

    template <typename Integer>
    void get(Integer &value) noexcept {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < sizeof(Integer); ++i) {
            bits |= static_cast<std::uint32_t>(bytes_[at_++]) << (8U * i);
        }
        value = static_cast<Integer>(bits);
    }
    template <typename Integer, std::size_t count>
    void get(std::array<Integer, count> &values) noexcept {
        for (Integer &value : values) {
            get(value);
        }
    }
    // True when all up to the CRC is zero.
    [[nodiscard]] bool rest_is_zero() const noexcept {
        const ReportBytes rest = bytes_.subspan(at_, bytes_.size() - kCrcSize - at_);
        return std::all_of(rest.begin(), rest.end(), [](std::uint8_t byte) { return byte == 0; });
    }

private:
    ReportBytes bytes_;
    std::size_t at_ = 1; // behind the report id
};

[[nodiscard]] Decoded check(ReportBytes bytes, std::size_t size, HidReportId id,
                            std::uint16_t seed = kHidProtocolVersion) noexcept {
    if (bytes.size() != size) {
        return Decoded::wrong_length;
    }
    if (bytes[0] != static_cast<std::uint8_t>(id)) {
        return Decoded::wrong_id;
    }
    const auto sent = static_cast<std::uint16_t>((bytes[size - 2] << 8) | bytes[size - 1]);
    return crc16(bytes.first(size - kCrcSize), seed) == sent ? Decoded::ok : Decoded::bad_crc;
}

} // namespace

std::array<std::uint8_t, kStateSize> encode(const StateReport &report) noexcept {
    Writer<kStateSize> writer(HidReportId::state);
    writer.put(report.flags);
    writer.put(report.sequence);
    writer.put(report.accepted_command);
    writer.put(report.device_time_us);
    writer.put(report.counts);
    writer.put(report.tensions_mn);
    writer.put(report.buttons);
    writer.put(report.fault_strings);
    writer.put(report.supply_mv);
    return writer.seal();
}

Decoded decode(ReportBytes bytes, StateReport &report) noexcept {
    const Decoded checked = check(bytes, kStateSize, HidReportId::state);
    if (checked != Decoded::ok) {
        return checked;
    }
    StateReport read;
    Reader reader(bytes);
    reader.get(read.flags);
    reader.get(read.sequence);
    reader.get(read.accepted_command);
    reader.get(read.device_time_us);
    reader.get(read.counts);
    reader.get(read.tensions_mn);
    reader.get(read.buttons);
    reader.get(read.fault_strings);
    reader.get(read.supply_mv);
    if (read.sequence == kNoSequence) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

std::array<std::uint8_t, kCommandSize> encode(const CommandReport &report) noexcept {
    Writer<kCommandSize> writer(HidReportId::command);
    writer.put(report.flags);
    writer.put(report.sequence);
    writer.put(report.valid_for_ms);
    writer.put(report.tensions_mn);
    writer.put(report.answers_state);
    writer.put(report.host_time_us);
    return writer.seal();
}

Decoded decode(ReportBytes bytes, CommandReport &report) noexcept {
    const Decoded checked = check(bytes, kCommandSize, HidReportId::command);
    if (checked != Decoded::ok) {
        return checked;
    }
    CommandReport read;
    Reader reader(bytes);
    reader.get(read.flags);
    reader.get(read.sequence);
    reader.get(read.valid_for_ms);
    reader.get(read.tensions_mn);
    reader.get(read.answers_state);
    reader.get(read.host_time_us);
    const bool known_flags = (read.flags & ~command_flag::kAll) == 0;
    if (!known_flags || read.sequence == kNoSequence || read.valid_for_ms == 0 ||
        !reader.rest_is_zero()) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

std::array<std::uint8_t, kCapabilitiesSize> encode(const HidCapabilities &report) noexcept {
    Writer<kCapabilitiesSize> writer(HidReportId::capabilities);
    writer.put(report.protocol_version);
    writer.put(report.motor_count);
    writer.put(std::uint8_t{0});
    writer.put(report.capabilities);
    writer.put(report.firmware_version);
    writer.put(report.unique_id);
    writer.put(report.counts_per_turn);
    writer.put(report.max_tension_mn);
    writer.put(report.max_tension_rate_mn_ms);
    writer.put(report.watchdog_limit_ms);
    writer.put(report.report_rate_hz);
    writer.put(report.max_force_mn);
    writer.put(report.max_moment_mnm);
    writer.put(report.max_grasp_torque_mnm);
    writer.put(report.max_stiffness_n_m);
    writer.put(report.workspace_mm);
    writer.put(report.max_string_speed_mm_s);
    writer.put(kCapabilitiesMagic);
    return writer.seal(kCapabilitiesSeed);
}

Decoded decode(ReportBytes bytes, HidCapabilities &report) noexcept {
    const Decoded checked =
        check(bytes, kCapabilitiesSize, HidReportId::capabilities, kCapabilitiesSeed);
    if (checked != Decoded::ok) {
        return checked;
    }
    HidCapabilities read;
    std::uint8_t reserved = 0;
    std::uint32_t magic = 0;
    Reader reader(bytes);
    reader.get(read.protocol_version);
    reader.get(read.motor_count);
    reader.get(reserved);
    reader.get(read.capabilities);
    reader.get(read.firmware_version);
    reader.get(read.unique_id);
    reader.get(read.counts_per_turn);
    reader.get(read.max_tension_mn);
    reader.get(read.max_tension_rate_mn_ms);
    reader.get(read.watchdog_limit_ms);
    reader.get(read.report_rate_hz);
    reader.get(read.max_force_mn);
    reader.get(read.max_moment_mnm);
    reader.get(read.max_grasp_torque_mnm);
    reader.get(read.max_stiffness_n_m);
    reader.get(read.workspace_mm);
    reader.get(read.max_string_speed_mm_s);
    reader.get(magic);
    if (magic != kCapabilitiesMagic) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

std::array<std::uint8_t, kLimitsSize> encode(const HidLimits &report) noexcept {
    Writer<kLimitsSize> writer(HidReportId::limits);
    writer.put(std::uint8_t{0});
    writer.put(report.max_tension_mn);
    writer.put(report.tension_rate_mn_ms);
    writer.put(report.string_speed_mm_s);
    writer.put(report.ramp_in_ms);
    writer.put(report.min_tension_mn);
    return writer.seal();
}

Decoded decode(ReportBytes bytes, HidLimits &report) noexcept {
    const Decoded checked = check(bytes, kLimitsSize, HidReportId::limits);
    if (checked != Decoded::ok) {
        return checked;
    }
    HidLimits read;
    std::uint8_t reserved = 0;
    Reader reader(bytes);
    reader.get(reserved);
    reader.get(read.max_tension_mn);
    reader.get(read.tension_rate_mn_ms);
    reader.get(read.string_speed_mm_s);
    reader.get(read.ramp_in_ms);
    reader.get(read.min_tension_mn);
    if (reserved != 0 || !reader.rest_is_zero() || read.min_tension_mn > read.max_tension_mn) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

std::array<std::uint8_t, kZeroSize> encode(const HidZero &report) noexcept {
    Writer<kZeroSize> writer(HidReportId::zero);
    writer.put(std::uint8_t{0});
    writer.put(kZeroMagic);
    writer.put(report.counts);
    return writer.seal();
}

Decoded decode(ReportBytes bytes, HidZero &report) noexcept {
    const Decoded checked = check(bytes, kZeroSize, HidReportId::zero);
    if (checked != Decoded::ok) {
        return checked;
    }
    HidZero read;
    std::uint8_t reserved = 0;
    std::uint32_t magic = 0;
    Reader reader(bytes);
    reader.get(reserved);
    reader.get(magic);
    reader.get(read.counts);
    if (reserved != 0 || magic != kZeroMagic) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

std::array<std::uint8_t, kDeviceControlSize> encode(DeviceControl report) noexcept {
    Writer<kDeviceControlSize> writer(HidReportId::device_control);
    writer.put(static_cast<std::uint8_t>(report));
    return writer.seal();
}

Decoded decode(ReportBytes bytes, DeviceControl &report) noexcept {
    const Decoded checked = check(bytes, kDeviceControlSize, HidReportId::device_control);
    if (checked != Decoded::ok) {
        return checked;
    }
    if (bytes[1] < static_cast<std::uint8_t>(DeviceControl::enable) ||
        bytes[1] > static_cast<std::uint8_t>(DeviceControl::proceed)) {
        return Decoded::bad_value;
    }
    report = static_cast<DeviceControl>(bytes[1]);
    return Decoded::ok;
}

} // namespace spidar
