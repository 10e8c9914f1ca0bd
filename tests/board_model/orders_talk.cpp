#include "board_model/orders_talk.h"

#include <array>
#include <sstream>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "board_model/known_buses.h"
#include "device/threads/real_time_thread.h"

namespace spidar::test {

namespace {

constexpr double kStill_m_s = 0.001;

template <typename Values>
void write_list(std::ostream &out, const char *name, const Values &values) {
    out << '"' << name << "\":[";
    const char *between = "";
    for (const auto &value : values) {
        out << between << value;
        between = ",";
    }
    out << "],";
}

} // namespace

OrdersTalk::OrdersTalk(const BusSettings &settings, BoardBus &bus)
    : settings_(settings), bus_(bus) {
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto *const plain = reinterpret_cast<sockaddr *>(&address);
    if (bind(socket_, plain, size) == 0 && getsockname(socket_, plain, &size) == 0) {
        port_ = ntohs(address.sin_port);
    }
}

OrdersTalk::~OrdersTalk() {
    close(socket_);
}

void OrdersTalk::step(bool pulled) {
    std::array<char, 512> text{};
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    auto *const plain = reinterpret_cast<sockaddr *>(&from);
    for (ssize_t count = 0;
         (count = recvfrom(socket_, text.data(), text.size(), 0, plain, &size)) > 0;) {
        take(std::string(text.data(), static_cast<std::size_t>(count)));
        const std::string truth = write_truth();
        (void)sendto(socket_, truth.data(), truth.size(), 0, plain, size);
    }
    orders_.target = target(pulled);
    bus_.order(orders_);
}

void OrdersTalk::take(const std::string &order) {
    std::istringstream words(order);
    std::string name;
    words >> name;
    if (name == "wave") {
        mode_ = Mode::wave;
    } else if (name == "pose") {
        HandTarget pose;
        Quat turn;
        Vec3 &at = pose.position_m;
        words >> at.x >> at.y >> at.z >> turn.w >> turn.x >> turn.y >> turn.z >>
            pose.grasp_angle_rad;
        pose.rotation = glm::mat3_cast(glm::normalize(turn));
        mode_ = words ? Mode::pose : mode_;
        orders_.target = words ? pose : orders_.target;
    } else if (name == "script") {
        std::string what;
        words >> what >> place_;
        script_ = what == "free"    ? HandScript::free_motion
                  : what == "place" ? HandScript::place
                                    : HandScript::home;
        mode_ = Mode::script;
        since_ns_ = monotonic_ns();
    } else if (name == "firmness") {
        int firmness = 1;
        words >> firmness;
        orders_.firmness = static_cast<HandFirmness>(firmness);
    } else if (name == "hang") {
        words >> orders_.hung_string >> orders_.weight_n;
    } else if (name == "mute") {
        int mute = 0;
        words >> mute;
        bus_.faults.silent.store(mute != 0);
    } else if (name == "slow") {
        int delay_ms = 0;
        words >> delay_ms;
        bus_.faults.delay_us.store(1000 * delay_ms);
    } else if (name == "unplug") {
        bus_.unplug();
    } else if (name == "plug") {
        (void)bus_.plug();
    } else if (name == "restart") {
        bus_.restart_boards();
    }
}

HandTarget OrdersTalk::target(bool pulled) {
    if (mode_ == Mode::wave && pulled != pulled_) {
        since_ns_ = monotonic_ns();
    }
    pulled_ = pulled;
    const double time_s = 1e-9 * static_cast<double>(monotonic_ns() - since_ns_);
    if (mode_ == Mode::script) {
        return calibration_hand(settings_.plant, script_, place_, time_s);
    }
    if (mode_ == Mode::wave) {
        return pulled ? wave(time_s) : HandTarget();
    }
    return orders_.target;
}

std::string OrdersTalk::write_truth() {
    const PlantTruth plant = bus_.truth(); // seen() brings newer ones
    const Wrench &felt = plant.strings;
    CountArray counts = bus_.counts();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        counts[i] += settings_.home_counts[i];
    }
    std::ostringstream out;
    out.precision(12);
    out << '{';
    write_list(out, "lengths_m", plant.lengths_m);
    write_list(out, "counts", counts); // as the boards count them
    write_list(out, "tensions_n", plant.tensions_n);
    const std::array<double, 7> wrench = {felt.force_n.x,      felt.force_n.y,   felt.force_n.z,
                                          felt.moment_nm.x,    felt.moment_nm.y, felt.moment_nm.z,
                                          felt.grasp_torque_nm};
    write_list(out, "strings_wrench", wrench);
    write_list(out, "position_m",
               std::array<double, 3>{plant.pose.position_m.x, plant.pose.position_m.y,
                                     plant.pose.position_m.z});
    write_list(out, "gain_errors", settings_.plant.length_gain_error);
    write_list(out, "tension_gains", settings_.plant.motors.tension_gain);
    const BusSeen seen = bus_.seen();
    std::vector<std::int64_t> masks;
    std::vector<int> ids;
    for (std::size_t i = 0; i < settings_.boards.size(); ++i) {
        masks.push_back(seen.masks[i]);
        ids.push_back(seen.ids[i]);
    }
    write_list(out, "masks", masks);
    write_list(out, "ids", ids);
    out << "\"flash_writes\":" << seen.flash_writes << ',';
    out << "\"grasp_angle\":" << plant.frame.grasp_angle_rad
        << ",\"still\":" << (glm::length(plant.twist.linear_m_s) < kStill_m_s ? "true" : "false")
        << ",\"strongest\":" << seen.strongest << "}\n";
    return out.str();
}

} // namespace spidar::test
