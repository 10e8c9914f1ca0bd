#include "device/hid/hid_session.h"

#include <algorithm>
#include <array>
#include <utility>

#include "device/hid/protocol/hid_codec.h"

namespace spidar {

namespace {

std::string name_of(const HidDeviceInfo &device) {
    return "\"" + device.product + "\" (serial \"" + device.serial + "\", " + device.path + ")";
}

// Reads and decodes feature report `id` of `size` bytes. Windows needs a buffer for the device's
// longest feature report, and may report that it filled all of it.
template <typename Report>
bool read_feature(HidHandle &handle, HidReportId id, std::size_t size, Report &report) {
    std::array<std::uint8_t, kLargestReport + 1> bytes{};
    bytes[0] = static_cast<std::uint8_t>(id);
    const int length = handle.get_feature(bytes);
    return length >= static_cast<int>(size) &&
           decode(ReportBytes(bytes).first(size), report) == Decoded::ok;
}

} // namespace

Status open_session(HidBus &bus, const HidDeviceInfo &device, const HidLimits &limits,
                    HidSession &session, std::string &problem) {
    HidSession opened;
    opened.device = device;
    for (auto *handle : {&opened.control, &opened.reader, &opened.writer}) {
        Status status = Status::ok;
        *handle = bus.open(device.path, status);
        if (!*handle) {
            problem = name_of(device) + ": " + describe(status);
            return status;
        }
    }
    if (!read_feature(*opened.control, HidReportId::capabilities, kCapabilitiesSize,
                      opened.capabilities)) {
        problem = name_of(device) + " does not answer with the capabilities of a SPIDAR-G; check "
                                    "its firmware against docs/reference/hid_protocol.md.";
        return Status::protocol_mismatch;
    }
    if (opened.capabilities.protocol_version != kHidProtocolVersion) {
        problem = name_of(device) + " uses protocol version " +
                  std::to_string(opened.capabilities.protocol_version) +
                  ", and this add-on uses version " + std::to_string(kHidProtocolVersion) +
                  "; update the older one.";
        return Status::protocol_mismatch;
    }
    if (opened.capabilities.motor_count != kStringCount) {
        problem = name_of(device) + " has " + std::to_string(opened.capabilities.motor_count) +
                  " motors; a SPIDAR-G has " + std::to_string(kStringCount) + ".";
        return Status::protocol_mismatch;
    }
    const auto wanted = encode(limits);
    if (opened.control->send_feature(wanted) < 0 ||
        !read_feature(*opened.control, HidReportId::limits, kLimitsSize, opened.limits) ||
        opened.limits.max_tension_mn > limits.max_tension_mn) {
        problem =
            name_of(device) +
            " did not accept the tension limits, so it stays closed; check its firmware against "
            "docs/reference/hid_protocol.md.";
        return Status::protocol_mismatch;
    }
    session = std::move(opened);
    problem.clear();
    return Status::ok;
}

} // namespace spidar
