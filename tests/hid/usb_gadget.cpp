#include "hid/usb_gadget.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "device/hid/hid_device_filter.h"
#include "device/hid/protocol/hid_descriptor.h"
#include "device/threads/real_time_thread.h"
#include "hid/vm_host.h"

namespace spidar::test {

namespace {

const std::string kGadget = "/sys/kernel/config/usb_gadget/spidar";
constexpr int kPollTimeout_ms = 100;

bool put(const std::string &path, const std::string &text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.flush();
    return file.good();
}

bool make_gadget() {
    const std::string function = kGadget + "/functions/hid.0";
    const std::string config = kGadget + "/configs/c.1";
    for (const std::string &folder : {kGadget, kGadget + "/strings/0x409", function, config}) {
        mkdir(folder.c_str(), 0755);
    }
    const std::string descriptor(kHidReportDescriptor.begin(), kHidReportDescriptor.end());
    return put(kGadget + "/idVendor", "0x1209") && put(kGadget + "/idProduct", "0x0001") &&
           put(kGadget + "/bcdUSB", "0x0200") &&
           put(kGadget + "/strings/0x409/product", "SPIDAR-G gadget") &&
           put(kGadget + "/strings/0x409/serialnumber", "VM-USB") &&
           put(function + "/protocol", "0") && put(function + "/report_length", "64") &&
           put(function + "/report_desc", descriptor) &&
           symlink(function.c_str(), (config + "/hid.0").c_str()) == 0 &&
           put(kGadget + "/UDC", "dummy_udc.0");
}

// Feature reports to the model, all else to the kernel.
class GadgetHandle final : public HidHandle {
public:
    GadgetHandle(std::unique_ptr<HidHandle> real, VirtualDevice &device)
        : real_(std::move(real)), device_(device) {}
    int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept override {
        return real_->read(bytes, timeout_ms);
    }
    int write(std::span<const std::uint8_t> bytes) noexcept override { return real_->write(bytes); }
    int get_feature(std::span<std::uint8_t> bytes) noexcept override {
        std::array<std::uint8_t, kLargestReport> report{};
        const std::size_t size = device_.with_firmware(
            [&](const FirmwareModel &firmware) { return firmware.get_feature(bytes[0], report); });
        if (size == 0 || size > bytes.size()) {
            return -1;
        }
        std::copy_n(report.begin(), size, bytes.begin());
        return static_cast<int>(size);
    }
    int send_feature(std::span<const std::uint8_t> bytes) noexcept override {
        const bool taken = device_.with_firmware(
            [&](FirmwareModel &firmware) { return firmware.set_feature(bytes); });
        return taken ? static_cast<int>(bytes.size()) : -1;
    }

private:
    std::unique_ptr<HidHandle> real_;
    VirtualDevice &device_;
};

class GadgetBus final : public HidBus {
public:
    explicit GadgetBus(VirtualDevice &device) : device_(device) {}
    Status enumerate(std::vector<HidDeviceInfo> &devices) override {
        return system_hid_bus()->enumerate(devices);
    }
    std::unique_ptr<HidHandle> open(const std::string &path, Status &status) override {
        auto real = system_hid_bus()->open(path, status);
        return real ? std::make_unique<GadgetHandle>(std::move(real), device_) : nullptr;
    }
    std::uint64_t now_us() noexcept override { return system_hid_bus()->now_us(); }

private:
    VirtualDevice &device_;
};

} // namespace

std::shared_ptr<HidBus> GadgetDevice::bus() {
    return std::make_shared<GadgetBus>(*this);
}

GadgetDevice::~GadgetDevice() {
    stop_.store(true);
    if (thread_.joinable()) {
        thread_.join();
    }
    put(kGadget + "/UDC", "\n");
    if (file_ >= 0) {
        close(file_);
    }
}

bool GadgetDevice::plug() {
    if (!make_gadget()) {
        return false;
    }
    HidDeviceFilter filter;
    filter.serial = "VM-USB";
    std::vector<HidDeviceInfo> found;
    constexpr int kPatience = 200;
    for (int i = 0; i < kPatience; ++i) {
        sleep_ms(20.0);
        if (file_ < 0) {
            file_ = open("/dev/hidg0", O_RDWR | O_NONBLOCK | O_CLOEXEC);
        }
        if (file_ >= 0 && usable(find_devices(*system_hid_bus(), filter, found))) {
            clear_observations();
            thread_ = std::thread([this] { run(); });
            return true;
        }
    }
    return false;
}

void GadgetDevice::run() {
    request_real_time();
    const int timer = millisecond_timer();
    while (!stop_.load()) {
        const short commands = take_commands_.load() ? POLLIN : short{0};
        std::array<pollfd, 2> files{pollfd{file_, commands, 0}, pollfd{timer, POLLIN, 0}};
        if (poll(files.data(), files.size(), kPollTimeout_ms) <= 0) {
            continue;
        }
        if ((files[0].revents & POLLIN) != 0) {
            std::array<std::uint8_t, kLargestReport> bytes{};
            const auto length = read(file_, bytes.data(), bytes.size());
            if (length > 0) {
                receive(ReportBytes(bytes).first(static_cast<std::size_t>(length)));
            }
        }
        std::uint64_t expirations = 0;
        if ((files[1].revents & POLLIN) == 0 ||
            read(timer, &expirations, sizeof expirations) <= 0) {
            continue;
        }
        for (const auto &report : tick(expirations)) {
            // Not taken: the endpoint is still busy with the last one. The sequence tells the host.
            [[maybe_unused]] const auto written = write(file_, report.data(), report.size());
        }
    }
    close(timer);
}

} // namespace spidar::test
