// The game is killed, crashes or is stopped while its motors pull: the guard brings the currents to zero, and is gone soon
// after the game.
#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "serial/serial_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kLimit_ms = 50.0;
constexpr std::int64_t kPulls = 50; // units of current: far more than the minimum tension

// It runs: one that has ended and waits for its parent to notice does not.
bool exists(int process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string line;
    std::getline(file, line);
    const std::size_t name_end = line.rfind(')');
    return name_end != std::string::npos && line.compare(name_end, 4, ") Z ") != 0;
}

// The same program, as a game of its own.
struct Game {
    pid_t process = -1;
    int words = -1;
    int guard = -1;
    int state = -1;

    explicit Game(const std::string &link) {
        int ends[2] = {-1, -1};
        REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
        const std::string itself = "/proc/self/exe";
        process = fork();
        REQUIRE(process >= 0);
        if (process == 0) {
            const rlimit no_core{0, 0};
            (void)setrlimit(RLIMIT_CORE, &no_core);
            dup2(ends[1], STDOUT_FILENO);
            execl(itself.c_str(), "spidar_serial_host", "--host", link.c_str(), nullptr);
            _exit(1);
        }
        close(ends[1]);
        words = ends[0];
        (void)fcntl(words, F_SETFL, O_NONBLOCK);
    }
    ~Game() {
        (void)kill(process, SIGKILL);
        (void)waitpid(process, nullptr, 0);
        close(words);
    }
    Game(const Game &) = delete;
    Game &operator=(const Game &) = delete;

    // Moves the hand for it until its motors pull. False: it has ended, or takes too long.
    bool plays(BoardBus &bus) {
        const std::int64_t start_ns = monotonic_ns();
        const auto pulls = [&] {
            bus.set_hand_target(wave(1e-9 * static_cast<double>(monotonic_ns() - start_ns)));
            listen();
            return state == static_cast<int>(DeviceState::active) && bus.seen().strongest > kPulls;
        };
        return wait_for([&] { return pulls() || !exists(process); }, 8000) && pulls();
    }
    // Takes in what it has said.
    void listen() {
        char bytes[256];
        const ssize_t count = read(words, bytes, sizeof bytes);
        for (ssize_t i = 0; i < count; ++i) {
            if (bytes[i] == '\n') {
                (line_[0] == 'g' ? guard : state) = std::atoi(line_.c_str() + 1);
                line_.clear();
            } else {
                line_ += bytes[i];
            }
        }
    }

private:
    std::string line_;
};

// Milliseconds from the signal until no motor has a current.
double off_after(int signal_number) {
    BoardBus bus(one_b5m(), link_of_this_test());
    // A busy machine may hold a game up for so long that it stops itself before it pulls: then another one plays.
    std::unique_ptr<Game> playing;
    bool pulls = false;
    for (int tries = 0; tries < 20 && !pulls; ++tries) {
        playing.reset();
        bus.set_hand_target(HandTarget());
        sleep_ms(tries == 0 ? 0 : 300);
        playing = std::make_unique<Game>(bus.link());
        pulls = playing->plays(bus);
    }
    REQUIRE(pulls);
    Game &game = *playing;
    REQUIRE(game.guard > 0);
    REQUIRE(exists(game.guard));

    const std::int64_t killed_ns = monotonic_ns();
    REQUIRE(kill(game.process, signal_number) == 0);
    REQUIRE(wait_for([&] { return bus.seen().strongest == 0; }, 2000));
    sleep_ms(60);
    const BusSeen seen = bus.seen();
    CHECK(seen.strongest == 0); // and stay so
    const double off_ms = 1e-6 * static_cast<double>(seen.last_pull_ns - killed_ns);
    CHECK(off_ms > -5.0); // it pulled until then

    if (signal_number == SIGSTOP) {
        CHECK(exists(game.guard)); // the game may go on: then it finds itself in FAULT
        REQUIRE(kill(game.process, SIGCONT) == 0);
        CHECK(wait_for(
            [&] {
                game.listen();
                return game.state != static_cast<int>(DeviceState::active);
            },
            500));
        // One command may have been on its way into the port when the game was stopped.
        CHECK(wait_for([&] { return bus.seen().strongest == 0; }, 20));
        sleep_ms(60);
        CHECK(bus.seen().strongest == 0);
        REQUIRE(kill(game.process, SIGKILL) == 0);
    }
    (void)waitpid(game.process, nullptr, 0);
    CHECK(
        wait_for([&] { return !exists(game.guard); }, 500)); // it never outlives the game for long
    return off_ms;
}

void repeat(int times) {
    for (const int signal_number : {SIGKILL, SIGSEGV, SIGSTOP}) {
        double worst_ms = 0.0;
        int in_time = 0;
        for (int i = 0; i < times; ++i) {
            const double off_ms = off_after(signal_number);
            worst_ms = std::max(worst_ms, off_ms);
            in_time += off_ms <= kLimit_ms ? 1 : 0;
        }
        MESSAGE(std::string(strsignal(signal_number))
                << ": currents zero within 50 ms in " << in_time << " of " << times << ", worst "
                << worst_ms << " ms");
        CHECK(in_time == times);
    }
}

} // namespace

TEST_SUITE_BEGIN("quick");
TEST_CASE("serial guard: a game that is killed, crashes or is stopped lets go within 50 ms") {
    repeat(1);
}
TEST_SUITE_END();

TEST_SUITE_BEGIN("long");
TEST_CASE("serial guard: the same, again and again") {
    const char *const times = std::getenv("SPIDAR_SERIAL_KILLS");
    repeat(times != nullptr ? std::atoi(times) : 20);
}
TEST_SUITE_END();
