// What another program tells the model's hand, and what it hears of the truth: datagrams of one line each, on this machine.
//   wave                             at home; while the motors pull, round and round (this is the start)
//   pose X Y Z QW QX QY QZ GRASP     there (m, quaternion, rad; device frame)
//   script home|free|place [N]       as the simulated device's hand while it is calibrated
//   firmness 0|1|2                   light, normal, firm
//   hang STRING WEIGHT_N             string 0 to 7 off the grip with a weight on it; -1 0: all strings on the grip
//   mute 0|1                         1: the boards' answers do not come through
//   slow MS                          answers come so much later
//   unplug, plug                     the bridge's cable
//   restart                          the boards' supply, for a moment
//   look                             nothing
// Each is answered with one line of JSON: the state of the plant and of the boards (write_truth()).
#pragma once

#include <cstdint>
#include <string>

#include "board_model/board_bus.h"
#include "device/calibration/calibration_hand.h"

namespace spidar::test {

class OrdersTalk {
public:
    OrdersTalk(const BusSettings &settings, BoardBus &bus);
    ~OrdersTalk();
    OrdersTalk(const OrdersTalk &) = delete;
    OrdersTalk &operator=(const OrdersTalk &) = delete;

    [[nodiscard]] int port() const noexcept { return port_; } // 0: there is none
    // Takes what has come and moves the hand. Never waits.
    void step(bool pulled);

private:
    enum class Mode { wave, pose, script };

    void take(const std::string &order);
    [[nodiscard]] HandTarget target(bool pulled);
    [[nodiscard]] std::string write_truth();

    const BusSettings &settings_;
    BoardBus &bus_;
    int socket_ = -1;
    int port_ = 0;
    Mode mode_ = Mode::wave;
    BusOrders orders_;
    HandScript script_ = HandScript::home;
    int place_ = 0;
    std::int64_t since_ns_ = 0; // of the script, or of the pull
    bool pulled_ = false;
};

} // namespace spidar::test
