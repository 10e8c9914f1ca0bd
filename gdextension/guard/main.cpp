// spidar_g_guard: a process that holds the serial port of a game's motor boards beside the game. It
// sends zero currents when the game dies, hangs or is stopped, since the boards alone would keep
// their last currents. device/serial/port_guard.cpp starts it with the port and a socket as file
// descriptors 3 and 4, and with the bytes to send, in hexadecimal, as its argument. It ends on a
// message or SIGTERM, when the game's end of the socket closes, or when its parent process changes.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <vector>

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "device/serial/guard_messages.h"

namespace {

using namespace spidar::guard;

constexpr int kPriority = 41; // one above that of the servo loop
constexpr int kFirstOfOthers = 5;
constexpr int kMostDescriptors = 4096;
constexpr int kPatience_ms =
    500; // interval of checks of the parent process before the game's first message

volatile std::sig_atomic_t told_to_end = 0;

void note_end(int /*signal*/) {
    told_to_end = 1;
}

int digit(char letter) {
    constexpr const char *kDigits = "0123456789abcdef";
    const char *const found = letter != '\0' ? std::strchr(kDigits, letter) : nullptr;
    return found != nullptr ? static_cast<int>(found - kDigits) : -1;
}

// Returns an empty vector when the text is not hexadecimal.
std::vector<std::uint8_t> bytes_of(const char *text) {
    std::vector<std::uint8_t> bytes;
    for (; text[0] != '\0'; text += 2) {
        const int high = digit(text[0]);
        const int low = digit(text[1]);
        if (high < 0 || low < 0) {
            return {};
        }
        bytes.push_back(static_cast<std::uint8_t>(high << 4 | low));
    }
    return bytes;
}

void prepare() {
    // Signals from the terminal that end the game must not end the guard before the game.
    for (const int ignored : {SIGINT, SIGHUP, SIGPIPE, SIGTSTP, SIGTTIN, SIGTTOU, SIGQUIT}) {
        (void)std::signal(ignored, SIG_IGN);
    }
    (void)std::signal(SIGTERM, note_end);
    // Closes all other files that this process inherited from the game.
    for (int other = kFirstOfOthers; other < kMostDescriptors; ++other) {
        (void)close(other);
    }
    sched_param priority{};
    priority.sched_priority = kPriority;
    (void)sched_setscheduler(0, SCHED_FIFO, &priority); // fails without the permission
    (void)mlockall(MCL_CURRENT | MCL_FUTURE);
}

void send_to_game(char word) {
    (void)send(kSocket, &word, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

// Never waits. If the output queue is full of the game's bytes, discards them.
void zero_currents(const std::vector<std::uint8_t> &off) {
    std::size_t done = 0;
    for (int tries = 0; tries < 3 && done < off.size(); ++tries) {
        const ssize_t count = write(kPort, off.data() + done, off.size() - done);
        if (count > 0) {
            done += static_cast<std::size_t>(count);
        } else if (errno == EAGAIN) {
            (void)tcflush(kPort, TCOFLUSH);
        }
    }
}

enum class Heard { nothing, life, end };

Heard listen(int timeout_ms) {
    pollfd socket{kSocket, POLLIN, 0};
    if (poll(&socket, 1, timeout_ms) <= 0) {
        return Heard::nothing;
    }
    std::array<char, 256> words{};
    const ssize_t count = recv(kSocket, words.data(), words.size(), MSG_DONTWAIT);
    if (count == 0 || (count < 0 && errno != EAGAIN)) {
        return Heard::end;
    }
    for (ssize_t i = 0; i < count; ++i) {
        if (words[static_cast<std::size_t>(i)] == kQuit) {
            return Heard::end;
        }
    }
    return count > 0 ? Heard::life : Heard::nothing;
}

void guard_port(const std::vector<std::uint8_t> &off, pid_t game) {
    bool begun = false;
    bool silent = false;
    send_to_game(kAlive);
    while (told_to_end == 0 && getppid() == game) {
        const int patience_ms = !begun ? kPatience_ms : silent ? kRepeat_ms : kSilence_ms;
        switch (listen(patience_ms)) {
        case Heard::end:
            return;
        case Heard::life:
            begun = true;
            silent = false;
            send_to_game(kAlive);
            break;
        case Heard::nothing:
            if (begun) {
                zero_currents(off);
                if (!silent) {
                    send_to_game(kZeroed);
                }
                silent = true;
            }
            break;
        }
    }
}

} // namespace

int main(int count, char **words) {
    const pid_t game = getppid();
    const std::vector<std::uint8_t> off = bytes_of(count == 2 ? words[1] : "");
    if (off.empty()) {
        return 2; // not started by the game
    }
    prepare();
    guard_port(off, game);
    for (int i = 0; i < kLastTimes; ++i) {
        zero_currents(off);
        (void)usleep(kRepeat_ms * 1000);
    }
    return 0;
}
