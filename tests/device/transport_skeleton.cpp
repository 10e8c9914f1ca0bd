// A skeleton of a transport for a board of your own, and a test that drives it: docs/how_to/add_a_transport.md. The board
// and its protocol are invented: it answers each command with a report of its eight encoder counts.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "device/contract/transport.h"
#include "support/servo_fixture.h"

using namespace spidar;

namespace {

// --- The operating system's side: a serial port, a socket, a USB endpoint ---
class Wire {
public:
    Wire() = default;
    Wire(const Wire &) = delete;
    Wire &operator=(const Wire &) = delete;
    virtual ~Wire() = default;
    virtual bool open() noexcept = 0;
    virtual void close() noexcept = 0;
    // Writes at most `room` of the bytes that have come in and tells how many. Never waits. -1: the device is gone.
    virtual int receive(std::uint8_t *bytes, std::size_t room) noexcept = 0;
    // Never waits. False: the device is gone.
    virtual bool send(const std::uint8_t *bytes, std::size_t size) noexcept = 0;
};

// --- The protocol: bytes alone, so that it is tested without a device ---
// Report: header, sequence (2), buttons, flags, 8 counts (4 each), check sum. Little-endian.
constexpr std::uint8_t kReport = 0xA5;
constexpr std::size_t kReportSize = 38;
constexpr std::uint8_t kZeroed = 1;
constexpr std::uint8_t kEmergencyStop = 2;
// Command: header, flags, 8 currents in mA (2 each), check sum.
constexpr std::uint8_t kCommand = 0x5A;
constexpr std::size_t kCommandSize = 19;
constexpr std::uint8_t kMotorsOn = 1;

std::uint8_t check_sum(const std::uint8_t *bytes, std::size_t size) noexcept {
    std::uint8_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
        sum = static_cast<std::uint8_t>(sum + bytes[i]);
    }
    return sum;
}

std::uint32_t number(const std::uint8_t *bytes, int size) noexcept {
    std::uint32_t value = 0;
    for (int i = size - 1; i >= 0; --i) {
        value = value << 8U | bytes[i];
    }
    return value;
}

void put(std::uint8_t *bytes, std::uint32_t value, int size) noexcept {
    for (int i = 0; i < size; ++i) {
        bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
}

// False: these bytes are no report.
bool decode(const std::uint8_t *bytes, DeviceReading &reading) noexcept {
    if (bytes[0] != kReport || bytes[kReportSize - 1] != check_sum(bytes, kReportSize - 1)) {
        return false;
    }
    reading.sequence = static_cast<std::uint16_t>(number(bytes + 1, 2));
    reading.buttons = bytes[3];
    reading.zeroed = (bytes[4] & kZeroed) != 0;
    reading.device_status =
        (bytes[4] & kEmergencyStop) != 0 ? Status::device_emergency_stop : Status::ok;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        reading.counts[i] = static_cast<std::int32_t>(number(bytes + 5 + 4 * i, 4));
    }
    return true;
}

std::array<std::uint8_t, kCommandSize> encode(const DriveCommand &command) noexcept {
    std::array<std::uint8_t, kCommandSize> bytes{kCommand};
    bytes[1] = command.motors_on ? kMotorsOn : std::uint8_t{0};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double most_a = command.motors_on ? 30.0 : 0.0;
        const double current_a = std::clamp(command.currents_a[i], -most_a, most_a);
        put(bytes.data() + 2 + 2 * i, static_cast<std::uint32_t>(std::lround(1e3 * current_a)), 2);
    }
    bytes.back() = check_sum(bytes.data(), bytes.size() - 1);
    return bytes;
}

// --- The transport ---
class BoardTransport final : public Transport {
public:
    explicit BoardTransport(std::shared_ptr<Wire> wire) : wire_(std::move(wire)) {}
    ~BoardTransport() override { close(); }

    Status open() noexcept override {
        size_ = 0;
        is_open_ = wire_->open();
        return is_open_ ? Status::ok : Status::no_device;
    }

    void close() noexcept override {
        if (is_open_) {
            (void)write(DriveCommand()); // motors off before the handle closes
            wire_->close();
        }
        is_open_ = false;
    }

    // Takes the newest whole report. What is no report is left out byte by byte. Allocates nothing and never waits: the
    // servo thread calls it.
    Status read(DeviceReading &reading) noexcept override {
        const int came =
            is_open_ ? wire_->receive(bytes_.data() + size_, bytes_.size() - size_) : -1;
        if (came < 0) {
            return Status::read_failed;
        }
        size_ += static_cast<std::size_t>(came);
        Status status = Status::read_timeout;
        std::size_t at = 0;
        while (at + kReportSize <= size_) {
            const bool good = decode(bytes_.data() + at, reading);
            status = good ? Status::ok : status;
            at += good ? kReportSize : 1;
        }
        std::copy(bytes_.begin() + at, bytes_.begin() + size_, bytes_.begin());
        size_ -= at;
        return status;
    }

    Status write(const DriveCommand &command) noexcept override {
        const auto bytes = encode(command);
        const bool sent = is_open_ && wire_->send(bytes.data(), bytes.size());
        return sent ? Status::ok : Status::write_failed;
    }

    // A name that this one device keeps: its motors' heat is remembered by it.
    [[nodiscard]] std::string device_name() const override { return "board:1"; }

private:
    std::shared_ptr<Wire> wire_;
    std::array<std::uint8_t, 8 * kReportSize> bytes_{}; // received and not used yet
    std::size_t size_ = 0;                              // of them
    bool is_open_ = false;
};

// --- A board for the test ---
class FakeBoard final : public Wire {
public:
    bool open() noexcept override { return plugged_in; }
    void close() noexcept override { closed_with_motors_on = motors_on; }
    int receive(std::uint8_t *bytes, std::size_t room) noexcept override {
        const std::size_t size = std::min(room, to_host.size());
        std::copy_n(to_host.begin(), size, bytes);
        to_host.erase(to_host.begin(), to_host.begin() + static_cast<std::ptrdiff_t>(size));
        return plugged_in ? static_cast<int>(size) : -1;
    }
    bool send(const std::uint8_t *bytes, std::size_t size) noexcept override {
        const bool sound = size == kCommandSize && bytes[0] == kCommand &&
                           bytes[size - 1] == check_sum(bytes, size - 1);
        refused += sound ? 0 : 1;
        if (sound) {
            motors_on = (bytes[1] & kMotorsOn) != 0;
            first_ma = static_cast<std::int16_t>(number(bytes + 2, 2));
            report();
        }
        return plugged_in;
    }
    void report() {
        std::array<std::uint8_t, kReportSize> bytes{kReport};
        put(bytes.data() + 1, ++sequence, 2);
        bytes[4] = kZeroed;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            put(bytes.data() + 5 + 4 * i, static_cast<std::uint32_t>(counts[i]), 4);
        }
        bytes.back() = check_sum(bytes.data(), bytes.size() - 1);
        to_host.insert(to_host.end(), bytes.begin(), bytes.end());
    }

    CountArray counts{};
    std::vector<std::uint8_t> to_host;
    std::uint16_t sequence = 0;
    int first_ma = 0;
    int refused = 0;
    bool plugged_in = true;
    bool motors_on = false;
    bool closed_with_motors_on = true;
};

} // namespace

TEST_CASE("transport skeleton: reports and commands pass as bytes, damaged ones do not") {
    auto board = std::make_shared<FakeBoard>();
    BoardTransport transport(board);
    DeviceReading reading;
    CHECK(transport.read(reading) == Status::read_failed); // not open
    REQUIRE(transport.open() == Status::ok);
    CHECK(transport.read(reading) == Status::read_timeout);
    board->counts = {1, -2, 300000, -300000, 5, 6, 7, 8};
    board->report();
    board->to_host.insert(board->to_host.begin(), {1, 2, kReport}); // the end of another report
    CHECK(transport.read(reading) == Status::ok);
    CHECK(reading.counts == board->counts);
    CHECK(reading.zeroed);
    board->report();
    board->to_host[7] ^= 1U;
    CHECK(transport.read(reading) == Status::read_timeout);
    DriveCommand command;
    command.motors_on = true;
    command.currents_a[0] = 1.25;
    CHECK(transport.write(command) == Status::ok);
    CHECK(board->first_ma == 1250);
    board->plugged_in = false;
    CHECK(transport.read(reading) == Status::read_failed);
    CHECK(transport.write(command) == Status::write_failed);
}

TEST_CASE(
    "transport skeleton: a servo loop finds the pose, pulls, and leaves with the motors off") {
    auto board = std::make_shared<FakeBoard>();
    ServoLoop loop(std::make_unique<BoardTransport>(board));
    const ServoSettings settings = test::ideal_settings();
    board->counts = test::counts_of(settings, test::moved_by(settings, Vec3(0.02, 0.0, -0.01)));
    REQUIRE(loop.start_stepped(settings) == Status::ok);
    HapticCommand command;
    command.forces_enabled = true;
    command.wrench_duration_s = 60.0;
    command.wrench.force_n = Vec3(0.0, 1.0, 0.0);
    command.wrench_sequence = 1;
    command.arm_count = 1;
    ServoSnapshot snapshot;
    for (int tick = 0; tick < 120; ++tick) {
        ++command.heartbeat;
        loop.publish(command);
        loop.advance(1, 60);
        (void)loop.latest(snapshot);
    }
    const Vec3 miss_m = snapshot.grip.pose.position_m - Vec3(0.02, 0.0, -0.01);
    CHECK(glm::length(miss_m) < 4e-5); // counts are 0.025 mm of string
    CHECK(snapshot.state == DeviceState::active);
    CHECK(std::abs(snapshot.achieved.force_n.y - 1.0) < 0.02);
    CHECK(board->motors_on);
    CHECK(board->first_ma > 0);
    loop.stop();
    CHECK_FALSE(board->motors_on);
    CHECK_FALSE(board->closed_with_motors_on);
    CHECK(board->refused == 0);
}
