// spidar_serial_tests: the serial transport against boards on a pseudo-terminal. With `--host LINK` it is the game that
// the tests kill: it brings the device at LINK to pull, says so on its standard output, and goes on for ever. With
// `--boards LINK` it is boards for another game.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>

#include <poll.h>

#include "serial/serial_rig.h"

namespace {

using namespace spidar;
using namespace spidar::test;

void say(char what, int number) {
    std::printf("%c%d\n", what, number);
    std::fflush(stdout);
}

int play_host(const char *link) {
    SerialHost host(settings_for(link));
    host.command.wrench.force_n = Vec3(0.0, 2.0, 0.0);
    if (!usable(host.start()) || !host.activate([](double) {}, 1)) { // the test moves the hand
        const SerialCounters c = host.transport->counters();
        std::fprintf(stderr, "host: %s %s %s\n", describe(host.now.state), describe(host.now.fault),
                     host.transport->problem().c_str());
        std::fprintf(
            stderr,
            "host: asked %llu, answered %llu, lost %llu, implausible %llu, damaged %llu, "
            "unasked %llu, guard trips %llu\n",
            static_cast<unsigned long long>(c.asked), static_cast<unsigned long long>(c.rounds),
            static_cast<unsigned long long>(c.lost), static_cast<unsigned long long>(c.implausible),
            static_cast<unsigned long long>(c.damaged), static_cast<unsigned long long>(c.unasked),
            static_cast<unsigned long long>(c.guard_trips));
        return 1;
    }
    say('g', host.transport->guard_process());
    for (DeviceState told = DeviceState::closed;;) {
        host.tick();
        if (host.now.state != told) {
            told = host.now.state;
            say('s', static_cast<int>(told));
        }
    }
}

// Boards at LINK and a hand that moves the grip while the motors pull, until the input ends. Says when the currents of the
// boards begin and when they end: "on NANOSECONDS", "off NANOSECONDS", of the machine's monotonic clock.
int play_boards(const char *link) {
    BoardBus bus(one_b5m(), link);
    std::printf("ready\n");
    std::fflush(stdout);
    pollfd input{STDIN_FILENO, POLLIN, 0};
    bool pulled = false;
    std::int64_t since_ns = 0;
    while (poll(&input, 1, 0) == 0) {
        const BusSeen seen = bus.seen();
        const bool pulls = seen.strongest > 0;
        if (pulls != pulled) {
            const std::int64_t at_ns = pulls ? monotonic_ns() : seen.last_pull_ns;
            std::printf("%s %lld\n", pulls ? "on" : "off", static_cast<long long>(at_ns));
            std::fflush(stdout);
            pulled = pulls;
            since_ns = monotonic_ns();
        }
        bus.set_hand_target(pulled ? wave(1e-9 * static_cast<double>(monotonic_ns() - since_ns))
                                   : HandTarget());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return 0;
}

} // namespace

int main(int count, char **words) {
    if (count == 3 && std::strcmp(words[1], "--host") == 0) {
        return play_host(words[2]);
    }
    if (count == 3 && std::strcmp(words[1], "--boards") == 0) {
        return play_boards(words[2]);
    }
    doctest::Context context(count, words);
    return context.run();
}
