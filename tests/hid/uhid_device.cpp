#include "hid/uhid_device.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include "device/hid/protocol/hid_descriptor.h"
#include "device/threads/real_time_thread.h"

namespace spidar::test {

namespace {

constexpr int kPollTimeout_ms = 100;
constexpr std::uint16_t kInputOutputError = 5;

void copy_text(const std::string &text, unsigned char *field, std::size_t size) {
    std::memcpy(field, text.data(), std::min(text.size(), size - 1));
}

} // namespace

UhidDevice::UhidDevice(UhidOptions options)
    : VirtualDevice(options.firmware), options_(std::move(options)) {}

UhidDevice::~UhidDevice() {
    unplug();
}

bool UhidDevice::send(const void *event, std::size_t size) const {
    return write(uhid_, event, size) > 0;
}

bool UhidDevice::plug() {
    unplug();
    uhid_ = open("/dev/uhid", O_RDWR | O_CLOEXEC);
    timer_ = millisecond_timer();
    if (uhid_ < 0 || timer_ < 0) {
        return false;
    }
    uhid_event event{};
    event.type = UHID_CREATE2;
    uhid_create2_req &create = event.u.create2;
    copy_text(options_.product, create.name, sizeof create.name);
    copy_text(options_.serial, create.uniq, sizeof create.uniq);
    create.bus = BUS_USB;
    create.vendor = options_.vendor_id;
    create.product = options_.product_id;
    create.rd_size = kHidReportDescriptor.size();
    std::copy(kHidReportDescriptor.begin(), kHidReportDescriptor.end(), create.rd_data);
    if (!send(&event, sizeof event)) {
        return false;
    }
    with_firmware([](FirmwareModel &firmware) { firmware.bus_reset(); });
    clear_observations();
    stop_.store(false);
    thread_ = std::thread([this] { run(); });
    return true;
}

void UhidDevice::unplug() {
    if (thread_.joinable()) {
        unplugged_ns_ = now_ns();
        stop_.store(true);
        thread_.join();
        with_firmware([](FirmwareModel &firmware) { firmware.bus_reset(); });
    }
    for (int *file : {&uhid_, &timer_}) {
        if (*file >= 0) {
            close(*file);
        }
        *file = -1;
    }
}

void UhidDevice::run() {
    request_real_time();
    std::array<pollfd, 2> files{pollfd{uhid_, POLLIN, 0}, pollfd{timer_, POLLIN, 0}};
    while (!stop_.load()) {
        if (poll(files.data(), files.size(), kPollTimeout_ms) <= 0) {
            continue;
        }
        if ((files[0].revents & POLLIN) != 0) {
            handle_event();
        }
        std::uint64_t expirations = 0;
        if ((files[1].revents & POLLIN) == 0 ||
            read(timer_, &expirations, sizeof expirations) <= 0) {
            continue;
        }
        for (const auto &report : tick(expirations)) {
            uhid_event event{};
            event.type = UHID_INPUT2;
            event.u.input2.size = static_cast<std::uint16_t>(report.size());
            std::copy(report.begin(), report.end(), event.u.input2.data);
            // Only the used part: 4 kB a millisecond would be the emulator's load, not the device's.
            send(&event, offsetof(uhid_event, u.input2.data) + report.size());
        }
    }
    unplugged_ns_ = now_ns();
    uhid_event event{};
    event.type = UHID_DESTROY;
    send(&event, sizeof event.type);
}

void UhidDevice::handle_event() {
    uhid_event event{};
    if (read(uhid_, &event, sizeof event) <= 0) {
        return;
    }
    uhid_event reply{};
    if (event.type == UHID_OUTPUT) {
        receive(ReportBytes(event.u.output.data, event.u.output.size));
    } else if (event.type == UHID_GET_REPORT) {
        std::array<std::uint8_t, kLargestReport> bytes{};
        const std::size_t size = with_firmware([&](const FirmwareModel &firmware) {
            return firmware.get_feature(event.u.get_report.rnum, bytes);
        });
        reply.type = UHID_GET_REPORT_REPLY;
        reply.u.get_report_reply.id = event.u.get_report.id;
        reply.u.get_report_reply.err = size == 0 ? kInputOutputError : std::uint16_t{0};
        reply.u.get_report_reply.size = static_cast<std::uint16_t>(size);
        std::copy(bytes.begin(), bytes.end(), reply.u.get_report_reply.data);
        send(&reply, sizeof reply);
    } else if (event.type == UHID_SET_REPORT) {
        const ReportBytes bytes(event.u.set_report.data, event.u.set_report.size);
        const bool taken =
            with_firmware([&](FirmwareModel &firmware) { return firmware.set_feature(bytes); });
        reply.type = UHID_SET_REPORT_REPLY;
        reply.u.set_report_reply.id = event.u.set_report.id;
        reply.u.set_report_reply.err = taken ? std::uint16_t{0} : kInputOutputError;
        send(&reply, sizeof reply);
    }
}

} // namespace spidar::test
