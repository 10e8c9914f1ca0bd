#include "device/hid/protocol/hid_codec.h"

#include <algorithm>
#include <concepts>
#include <type_traits>

#include "device/hid/protocol/crc16.h"
#include "device/hid/protocol/report_sequence.h"

namespace spidar {

namespace {

// "SPDG" and "ZERO" in ASCII: other feature reports are not accepted as these.
constexpr std::uint32_t kCapabilitiesMagic = 0x47445053;
constexpr std::uint32_t kZeroMagic = 0x4F52455A;
constexpr std::size_t kCrcSize = 2;
// Seed of the capabilities' CRC in every version, so that a host can read which version a device
// uses.
constexpr std::uint16_t kCapabilitiesSeed = 0;

// Writes fields one after another, little-endian. seal() puts the CRC in the last two bytes, high
// byte first: only then does the CRC detect every burst of wrong bits that reaches into it.
template <std::size_t size>
class Writer {
public:
    explicit Writer(HidReportId id) noexcept { put(static_cast<std::uint8_t>(id)); }

    template <typename... Fields>
    void all(const Fields &...fields) noexcept {
        (put(fields), ...);
    }
    // Writes a constant that every report of this kind holds here.
    template <typename Integer>
    void constant(Integer value) noexcept {
        put(value);
    }
    void reserved() noexcept { put(std::uint8_t{0}); }

    [[nodiscard]] std::array<std::uint8_t, size>
    seal(std::uint16_t seed = kHidProtocolVersion) noexcept {
        const std::uint16_t crc = crc16(ReportBytes(bytes_).first(size - kCrcSize), seed);
        bytes_[size - 2] = static_cast<std::uint8_t>(crc >> 8U);
        bytes_[size - 1] = static_cast<std::uint8_t>(crc);
        return bytes_;
    }

private:
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

    std::array<std::uint8_t, size> bytes_{};
    std::size_t at_ = 0;
};

// Reads the fields back. Requires bytes whose length was checked.
class Reader {
public:
    explicit Reader(ReportBytes bytes) noexcept : bytes_(bytes) {}

    template <typename... Fields>
    void all(Fields &...fields) noexcept {
        (get(fields), ...);
    }
    template <typename Integer>
    void constant(Integer expected) noexcept {
        Integer value{};
        get(value);
        good_ = good_ && value == expected;
    }
    void reserved() noexcept { ++at_; }

    // True when every constant had its expected value.
    [[nodiscard]] bool good() const noexcept { return good_; }
    // Returns true when all bytes up to the CRC are zero.
    [[nodiscard]] bool rest_is_zero() const noexcept {
        const ReportBytes rest = bytes_.subspan(at_, bytes_.size() - kCrcSize - at_);
        return std::all_of(rest.begin(), rest.end(), [](std::uint8_t byte) { return byte == 0; });
    }

private:
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

    ReportBytes bytes_;
    std::size_t at_ = 1; // after the report id
    bool good_ = true;
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

template <typename T, typename Report>
concept Either = std::same_as<std::remove_const_t<T>, Report>;

// The fields of each report in wire order, used by Writer and Reader.
template <typename Wire, Either<StateReport> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.all(report.flags, report.sequence, report.accepted_command, report.device_time_us,
             report.counts, report.tensions_mn, report.buttons, report.fault_strings,
             report.supply_mv);
}

template <typename Wire, Either<CommandReport> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.all(report.flags, report.sequence, report.valid_for_ms, report.tensions_mn,
             report.answers_state, report.host_time_us);
}

template <typename Wire, Either<HidCapabilities> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.all(report.protocol_version, report.motor_count);
    wire.reserved();
    wire.all(report.capabilities, report.firmware_version, report.unique_id, report.counts_per_turn,
             report.max_tension_mn, report.max_tension_rate_mn_ms, report.watchdog_limit_ms,
             report.report_rate_hz, report.max_force_mn, report.max_moment_mnm,
             report.max_grasp_torque_mnm, report.max_stiffness_n_m, report.workspace_mm,
             report.max_string_speed_mm_s);
    wire.constant(kCapabilitiesMagic);
}

template <typename Wire, Either<HidLimits> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.constant(std::uint8_t{0});
    wire.all(report.max_tension_mn, report.tension_rate_mn_ms, report.string_speed_mm_s,
             report.ramp_in_ms, report.min_tension_mn);
}

template <typename Wire, Either<HidZero> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.constant(std::uint8_t{0});
    wire.constant(kZeroMagic);
    wire.all(report.counts);
}

template <typename Wire, Either<DeviceControl> Report>
void fields(Wire &wire, Report &report) noexcept {
    wire.all(report);
}

template <std::size_t size, typename Report>
[[nodiscard]] std::array<std::uint8_t, size>
encoded(HidReportId id, const Report &report, std::uint16_t seed = kHidProtocolVersion) noexcept {
    Writer<size> writer(id);
    fields(writer, report);
    return writer.seal(seed);
}

// good(report, reader): condition on the decoded values.
template <typename Report, typename Good>
[[nodiscard]] Decoded decoded(ReportBytes bytes, std::size_t size, HidReportId id, Report &report,
                              Good good, std::uint16_t seed = kHidProtocolVersion) noexcept {
    const Decoded checked = check(bytes, size, id, seed);
    if (checked != Decoded::ok) {
        return checked;
    }
    Report read{};
    Reader reader(bytes);
    fields(reader, read);
    if (!reader.good() || !good(read, reader)) {
        return Decoded::bad_value;
    }
    report = read;
    return Decoded::ok;
}

} // namespace

std::array<std::uint8_t, kStateSize> encode(const StateReport &report) noexcept {
    return encoded<kStateSize>(HidReportId::state, report);
}

Decoded decode(ReportBytes bytes, StateReport &report) noexcept {
    return decoded(bytes, kStateSize, HidReportId::state, report,
                   [](const StateReport &read, const Reader & /*reader*/) {
                       return read.sequence != kNoSequence;
                   });
}

std::array<std::uint8_t, kCommandSize> encode(const CommandReport &report) noexcept {
    return encoded<kCommandSize>(HidReportId::command, report);
}

Decoded decode(ReportBytes bytes, CommandReport &report) noexcept {
    return decoded(bytes, kCommandSize, HidReportId::command, report,
                   [](const CommandReport &read, const Reader &reader) {
                       const bool known_flags = (read.flags & ~command_flag::kAll) == 0;
                       return known_flags && read.sequence != kNoSequence &&
                              read.valid_for_ms != 0 && reader.rest_is_zero();
                   });
}

std::array<std::uint8_t, kCapabilitiesSize> encode(const HidCapabilities &report) noexcept {
    return encoded<kCapabilitiesSize>(HidReportId::capabilities, report, kCapabilitiesSeed);
}

Decoded decode(ReportBytes bytes, HidCapabilities &report) noexcept {
    return decoded(
        bytes, kCapabilitiesSize, HidReportId::capabilities, report,
        [](const HidCapabilities & /*read*/, const Reader & /*reader*/) { return true; },
        kCapabilitiesSeed);
}

std::array<std::uint8_t, kLimitsSize> encode(const HidLimits &report) noexcept {
    return encoded<kLimitsSize>(HidReportId::limits, report);
}

Decoded decode(ReportBytes bytes, HidLimits &report) noexcept {
    return decoded(bytes, kLimitsSize, HidReportId::limits, report,
                   [](const HidLimits &read, const Reader &reader) {
                       return reader.rest_is_zero() && read.min_tension_mn <= read.max_tension_mn;
                   });
}

std::array<std::uint8_t, kZeroSize> encode(const HidZero &report) noexcept {
    return encoded<kZeroSize>(HidReportId::zero, report);
}

Decoded decode(ReportBytes bytes, HidZero &report) noexcept {
    return decoded(bytes, kZeroSize, HidReportId::zero, report,
                   [](const HidZero & /*read*/, const Reader & /*reader*/) { return true; });
}

std::array<std::uint8_t, kDeviceControlSize> encode(DeviceControl report) noexcept {
    return encoded<kDeviceControlSize>(HidReportId::device_control, report);
}

Decoded decode(ReportBytes bytes, DeviceControl &report) noexcept {
    return decoded(bytes, kDeviceControlSize, HidReportId::device_control, report,
                   [](DeviceControl read, const Reader & /*reader*/) {
                       return read >= DeviceControl::enable && read <= DeviceControl::proceed;
                   });
}

} // namespace spidar
