// spidar_serial_tests: the serial transport against boards on a pseudo-terminal. With `--host LINK` it is the game that
// the tests kill: it brings the device at LINK to pull, says so on its standard output, and goes on for ever.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>

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

} // namespace

int main(int count, char **words) {
    if (count == 3 && std::strcmp(words[1], "--host") == 0) {
        return play_host(words[2]);
    }
    doctest::Context context(count, words);
    return context.run();
}
