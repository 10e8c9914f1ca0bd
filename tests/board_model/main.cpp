// spidar_board_model: serial motor boards with a SPIDAR-G and a hand on them, for another program to use as a port.
//   spidar_board_model LINK [--boards b5m|2b3m] [--errors SEED] [--mask MASK]
// The port is the symbolic link LINK. --errors draws errors of strings and motors that a calibration has to find, and counts
// that begin anywhere. --mask is the quadrature mask in the boards' flash. Prints "ready UDP_PORT", then "on NS" and "off NS"
// when the boards' currents begin and end, of the machine's monotonic clock. Ends with its standard input. What the hand
// does is told by datagrams to UDP_PORT of this machine: see orders_talk.h.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include <poll.h>
#include <unistd.h>

#include "board_model/known_buses.h"
#include "board_model/orders_talk.h"
#include "device/threads/real_time_thread.h"

namespace {

using namespace spidar;
using namespace spidar::test;

struct Options {
    std::string link;
    bool two_boards = false;
    unsigned errors = 0; // seed; 0: none
    std::uint32_t mask = 0xFF;
    bool good = false;
};

Options read_options(int count, char **words) {
    Options options;
    options.good = count >= 2 && count % 2 == 0;
    options.link = count >= 2 ? words[1] : "";
    for (int i = 2; i + 1 < count; i += 2) {
        const std::string name = words[i];
        const std::string value = words[i + 1];
        if (name == "--boards") {
            options.two_boards = value == "2b3m";
        } else if (name == "--errors") {
            options.errors = static_cast<unsigned>(std::strtoul(value.c_str(), nullptr, 10));
        } else if (name == "--mask") {
            options.mask = static_cast<std::uint32_t>(std::strtoul(value.c_str(), nullptr, 0));
        } else {
            options.good = false;
        }
    }
    return options;
}

// As the practice of the calibration panel draws them: a thumb's width of offset, drums wound thick or thin, motors a tenth off.
void draw_errors(unsigned seed, BusSettings &settings) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(-1.0, 1.0);
    const double common = 0.03 * even(random);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        settings.plant.length_offset_error_m[i] = 0.005 * normal(random);
        settings.plant.length_gain_error[i] = common + 0.005 * normal(random);
        // As SpidarGConfig.simulated_gain_errors: more counts a metre are a smaller drum, which pulls harder.
        settings.plant.motors.effective_radius_m[i] /= 1.0 + settings.plant.length_gain_error[i];
        settings.plant.motors.tension_gain[i] = 1.0 + 0.12 * even(random);
        settings.home_counts[i] = static_cast<std::int32_t>(20'000.0 * even(random));
    }
}

void tell_pull(const BusSeen &seen, bool &pulled) {
    const bool pulls = seen.strongest > 0;
    if (pulls != pulled) {
        const std::int64_t at_ns = pulls ? monotonic_ns() : seen.last_pull_ns;
        std::printf("%s %lld\n", pulls ? "on" : "off", static_cast<long long>(at_ns));
        std::fflush(stdout);
        pulled = pulls;
    }
}

} // namespace

int main(int count, char **words) {
    const Options options = read_options(count, words);
    if (!options.good) {
        std::fprintf(stderr, "usage: spidar_board_model LINK [--boards b5m|2b3m] [--errors SEED] "
                             "[--mask MASK]\n");
        return 2;
    }
    BusSettings settings = options.two_boards ? two_b3m() : one_b5m();
    if (options.errors != 0) {
        draw_errors(options.errors, settings);
    }
    BoardBus bus(settings, options.link);
    bus.with_boards([&](auto &boards) {
        for (BoardFirmware &board : boards) {
            board.quadrature_mask = options.mask;
        }
    });
    OrdersTalk talk(settings, bus);
    if (talk.port() == 0) {
        std::fprintf(stderr, "spidar_board_model: no socket\n");
        return 1;
    }
    std::printf("ready %d\n", talk.port());
    std::fflush(stdout);
    pollfd input{STDIN_FILENO, POLLIN, 0};
    for (bool pulled = false; poll(&input, 1, 1) == 0;) {
        const BusSeen seen = bus.seen();
        tell_pull(seen, pulled);
        talk.step(pulled);
    }
    return 0;
}
