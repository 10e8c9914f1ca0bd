// A disk that stands still when told to: what is written waits, as on a busy machine, whatever the machine's speed.
#pragma once

#include <string>

#if defined(__unix__)
#include <atomic>
#include <cstdio>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace spidar::test {

#if defined(__unix__)

// A pipe of one page before the file: who writes to it waits as soon as nobody reads. It outlives its writer.
class StallingDisk {
public:
    explicit StallingDisk(const std::string &file)
        : path_(file + ".pipe"), file_(file, std::ios::binary) {
        made_ = ::mkfifo(path_.c_str(), 0600) == 0;
        pipe_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
#if defined(F_SETPIPE_SZ)
        made_ = ::fcntl(pipe_, F_SETPIPE_SZ, 4096) > 0 && made_;
#endif
        copier_ = std::thread([this] { copy(); });
    }
    ~StallingDisk() {
        finish();
    }
    StallingDisk(const StallingDisk &) = delete;
    StallingDisk &operator=(const StallingDisk &) = delete;

    [[nodiscard]] bool is_usable() const {
        return made_ && pipe_ >= 0;
    }
    [[nodiscard]] const std::string &path() const {
        return path_;
    }
    void stall() {
        stalled_ = true;
    }
    void go_on() {
        stalled_ = false;
    }
    // After the writer has closed it: the rest comes to the file.
    void finish() {
        if (copier_.joinable()) {
            go_on();
            ended_ = true;
            copier_.join();
            file_.close();
            ::close(pipe_);
            std::remove(path_.c_str());
        }
    }

private:
    void copy() {
        char bytes[4096];
        pollfd waits{pipe_, POLLIN, 0};
        for (;;) {
            const bool ends = ended_;
            if (stalled_) {
                std::this_thread::yield();
                continue;
            }
            constexpr int kLook_ms = 1;
            (void)::poll(&waits, 1, kLook_ms);
            const ssize_t size = ::read(pipe_, bytes, sizeof bytes);
            if (size > 0) {
                file_.write(bytes, size);
            } else if (ends) {
                return;
            }
        }
    }

    std::string path_;
    std::ofstream file_;
    bool made_ = false;
    int pipe_ = -1;
    std::atomic<bool> stalled_{false};
    std::atomic<bool> ended_{false};
    std::thread copier_;
};

#else

// Without pipes that have names: the file itself, which a fast enough loop overtakes by itself.
class StallingDisk {
public:
    explicit StallingDisk(const std::string &file) : path_(file) {}
    [[nodiscard]] bool is_usable() const { return true; }
    [[nodiscard]] const std::string &path() const { return path_; }
    void stall() {}
    void go_on() {}
    void finish() {}

private:
    std::string path_;
};

#endif

} // namespace spidar::test
