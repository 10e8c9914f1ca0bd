#include "device/serial/port_guard.h"

#include "device/serial/guard_messages.h"

#ifdef __linux__
#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/threads/real_time_thread.h"
#endif

namespace spidar {

#ifdef __linux__

namespace {

constexpr int kStart_ms = 500;
constexpr int kEnd_ms = 500;
constexpr int kOutOfTheWay = 64; // descriptors from here on do not collide with the guard's

std::string hexadecimal(BoardBytes bytes) {
    constexpr const char *kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += kDigits[byte >> 4U];
        text += kDigits[byte & 0xFU];
    }
    return text;
}

// Closes the descriptor in its destructor.
struct Descriptor {
    int number = -1;
    Descriptor() = default;
    ~Descriptor() {
        if (number >= 0) {
            close(number);
        }
    }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
};

// An exported or unpacked game may have lost the file's executable flag: then a copy in memory,
// which has the flag, is started. Returns an empty string when there is no such file.
std::string startable(const std::string &program, Descriptor &copy) {
    if (access(program.c_str(), X_OK) == 0) {
        return program;
    }
    std::ifstream file(program, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    copy.number = memfd_create("spidar_g_guard", MFD_CLOEXEC);
    if (bytes.empty() || copy.number < 0 ||
        write(copy.number, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
        return {};
    }
    const int away = fcntl(copy.number, F_DUPFD_CLOEXEC, kOutOfTheWay);
    close(copy.number);
    copy.number = away;
    return "/proc/self/fd/" + std::to_string(away);
}

int moved_away(int descriptor) {
    return fcntl(descriptor, F_DUPFD_CLOEXEC, kOutOfTheWay);
}

// The guard has its own process group, so that Ctrl-C in the game's terminal does not end it before
// the game, and default signals.
int spawn(const std::string &program, const std::string &off, int port, int socket) {
    const std::array<int, 2> given = {moved_away(port), moved_away(socket)};
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, given[0], guard::kPort);
    posix_spawn_file_actions_adddup2(&files, given[1], guard::kSocket);
    posix_spawnattr_t attributes{};
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t none{};
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    std::string name = program;
    std::string bytes = off;
    const std::array<char *, 3> words = {name.data(), bytes.data(), nullptr};
    const std::array<char *, 1> no_environment = {nullptr};
    pid_t process = -1;
    const int error = posix_spawn(&process, program.c_str(), &files, &attributes, words.data(),
                                  no_environment.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    for (const int descriptor : given) {
        if (descriptor >= 0) {
            close(descriptor);
        }
    }
    return error == 0 ? process : -1;
}

} // namespace

std::string PortGuard::start(const std::string &program, int port, BoardBytes off) {
    end();
    std::array<int, 2> ends = {-1, -1};
    Descriptor copy;
    const std::string start_from = startable(program, copy);
    if (start_from.empty()) {
        return "The guard " + program +
               " is missing. Without it nothing switches the motors off if the game crashes, so "
               "they stay off. Put the file beside the add-on's library.";
    }
    if (port < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return "The guard cannot be given the port on this system, so the motors stay off.";
    }
    process_ = spawn(start_from, hexadecimal(off), port, ends[1]);
    close(ends[1]);
    socket_ = ends[0];
    pollfd answer{socket_, POLLIN, 0};
    char byte = 0;
    if (process_ < 0 || poll(&answer, 1, kStart_ms) != 1 ||
        recv(socket_, &byte, 1, MSG_DONTWAIT) != 1) {
        end();
        return "The guard " + program + " does not start, so the motors stay off.";
    }
    answered_ns_ = monotonic_ns();
    tripped_ = false;
    alive_.store(true, std::memory_order_release);
    return {};
}

void PortGuard::end() noexcept {
    alive_.store(false, std::memory_order_release);
    if (socket_ >= 0) {
        (void)send(socket_, &guard::kQuit, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
        close(socket_);
        socket_ = -1;
    }
    if (process_ < 0) {
        return;
    }
    for (int waited_ms = 0; waited_ms < kEnd_ms; ++waited_ms) {
        if (waitpid(process_, nullptr, WNOHANG) != 0) {
            process_ = -1;
            return;
        }
        usleep(1000);
    }
    (void)kill(process_, SIGKILL); // it hangs and guards nothing
    (void)waitpid(process_, nullptr, 0);
    process_ = -1;
}

void PortGuard::beat(std::int64_t now_ns) noexcept {
    if (!alive()) {
        return;
    }
    std::array<char, 64> said{};
    const bool sent = send(socket_, &guard::kBeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1;
    const ssize_t count = recv(socket_, said.data(), said.size(), MSG_DONTWAIT);
    for (ssize_t i = 0; i < count; ++i) {
        tripped_ = tripped_ || said[static_cast<std::size_t>(i)] == guard::kZeroed;
    }
    if (count > 0) {
        answered_ns_ = now_ns;
    }
    if (!sent || count == 0 || now_ns - answered_ns_ > kSilent_ns) {
        alive_.store(false, std::memory_order_release);
    }
}

std::string guard_beside_library() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void *>(&guard_beside_library), &info) == 0 ||
        info.dli_fname == nullptr) {
        return kGuardFile;
    }
    const std::string file = info.dli_fname;
    return file.substr(0, file.rfind('/') + 1) + kGuardFile;
}

#else

std::string PortGuard::start(const std::string & /*program*/, int /*port*/, BoardBytes /*off*/) {
    return "There is no guard for this system yet. Without a guard nothing switches the motors off "
           "if the game crashes, so they stay off.";
}
void PortGuard::end() noexcept {}
void PortGuard::beat(std::int64_t /*now_ns*/) noexcept {}
std::string guard_beside_library() {
    return {};
}

#endif

} // namespace spidar
