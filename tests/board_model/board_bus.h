// A bus of simulated boards on a pseudo-terminal, in a thread of its own: what a serial port with a SPIDAR behind it is
// to a host. Its motors pull the strings of the same plant as the simulated device's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "board_model/board_firmware.h"
#include "board_model/hung_weight.h"
#include "device/simulation/simulated_plant.h"
#include "device/threads/triple_buffer.h"

namespace spidar::test {

struct BusSettings {
    std::vector<BoardLayout> boards;
    PlantSettings plant;
    double units_per_a = 100.0; // of the boards' currents
    CountArray
        home_counts{}; // where the boards begin to count: they are switched on with the grip at home
};

// What is done to the device from outside.
struct BusOrders {
    HandTarget target;
    HandFirmness firmness = HandFirmness::normal;
    int hung_string = -1; // taken off the grip, with a weight on it; -1: none
    double weight_n = 0.0;
};

// What happens to the bytes of the boards' answers; shares of the reads of the bus thread.
struct LineFaults {
    std::atomic<double> lost_bytes{0.0};
    std::atomic<double> garbage{0.0};
    std::atomic<bool> silent{false}; // the host hears nothing
    std::atomic<int> delay_us{0};    // answers come so much later: a slow bridge
};

struct BusSeen {
    std::int64_t last_pull_ns = 0; // when a current was last not zero; 0: never
    std::int64_t strongest = 0;    // of the currents now, in units
    std::int64_t strongest_ever = 0;
    std::uint64_t heard_bytes = 0;
    std::uint64_t currents = 0; // CURRENT commands carried out, by all boards
    std::uint64_t cut_replies = 0;
    // In flash.
    std::array<std::uint32_t, kMostBoards> masks{};
    std::array<std::uint8_t, kMostBoards> ids{};
    std::uint64_t flash_writes = 0;
};

class BoardBus {
public:
    // Plugged in, at `link`, a symbolic link to the pseudo-terminal.
    BoardBus(const BusSettings &settings, std::string link);
    ~BoardBus();
    BoardBus(const BoardBus &) = delete;
    BoardBus &operator=(const BoardBus &) = delete;

    // The cable of the bridge: the boards keep their power, and their currents.
    void unplug();
    bool plug();
    // The board's supply, for a moment.
    void restart_boards();

    [[nodiscard]] const std::string &link() const { return link_; }
    // From one thread, without a lock: a test that is held up must not hold the bus up.
    [[nodiscard]] BusSeen seen() { return newest().seen; }
    [[nodiscard]] CountArray counts() { return newest().counts; } // of the strings since power-up
    [[nodiscard]] const PlantTruth &truth() { return newest().truth; }
    void set_hand_target(const HandTarget &target) {
        orders_.target = target;
        order(orders_);
    }
    void order(const BusOrders &orders) { orders_box_.write(orders); }
    template <typename Work>
    auto with_boards(const Work &work) {
        const std::lock_guard<std::mutex> lock(mutex_);
        return work(boards_);
    }
    LineFaults faults;

private:
    struct News {
        BusSeen seen;
        CountArray counts{};
        PlantTruth truth;
    };
    const News &newest() {
        (void)news_.read(read_);
        return read_;
    }
    void run();
    // Returns whether something was heard.
    bool serve(std::vector<std::uint8_t> &answer);
    void move_on(std::int64_t now_ns);
    void damage(std::vector<std::uint8_t> &answer);
    void send_due(std::int64_t now_ns);

    const BusSettings settings_;
    const std::string link_;
    BusOrders orders_; // the caller's
    TripleBuffer<BusOrders> orders_box_;
    TripleBuffer<News> news_;
    News read_;
    std::mutex mutex_; // all below
    int master_ = -1;
    std::vector<BoardFirmware> boards_;
    struct Late {
        std::int64_t due_ns = 0;
        std::vector<std::uint8_t> bytes;
    };
    std::deque<Late> late_; // answers on their way
    BusOrders taken_;
    SimulatedPlant plant_;
    HungWeight weight_;
    StringArray newtons_per_ampere_{};
    std::int64_t moved_ns_ = 0;
    CountArray counts_{};
    CountArray home_{}; // counts at power-up
    BusSeen seen_;
    std::uint64_t random_ = 1;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace spidar::test
