#include "board_model/board_bus.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "device/threads/real_time_thread.h"

namespace spidar::test {

namespace {

constexpr std::int64_t kTick_ns = 200'000;
constexpr std::int64_t kLongestStep_ns = 20'000'000; // of the plant, after this thread slept

// No echo, no line editing: bytes as they are.
bool make_raw(const char *slave) {
    const int port = open(slave, O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    const bool good = port >= 0 && tcgetattr(port, &settings) == 0;
    cfmakeraw(&settings);
    const bool set = good && tcsetattr(port, TCSANOW, &settings) == 0;
    if (port >= 0) {
        close(port);
    }
    return set;
}

} // namespace

BoardBus::BoardBus(const BusSettings &settings, std::string link)
    : settings_(settings), link_(std::move(link)),
      boards_(settings.boards.begin(), settings.boards.end()), plant_(settings.plant),
      newtons_per_ampere_(motor_scale(settings.plant.motors).tension_per_ampere_n_a) {
    counts_ = plant_.counts();
    home_ = counts_;
    moved_ns_ = monotonic_ns();
    std::size_t string = 0;
    for (BoardFirmware &board : boards_) { // counted from power-up, which is at home
        for (std::size_t i = 0; i < board.layout().motors() && string < counts_.size(); ++i) {
            board.turn(i, counts_[string] - settings.home_counts[string], 0.0);
            ++string;
        }
        board.restart();
    }
    plug();
    thread_ = std::thread([this] { run(); });
}

BoardBus::~BoardBus() {
    stop_.store(true);
    thread_.join();
    unplug();
}

void BoardBus::unplug() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (master_ >= 0) {
        close(master_);
    }
    master_ = -1;
    (void)::unlink(link_.c_str());
}

bool BoardBus::plug() {
    const std::lock_guard<std::mutex> lock(mutex_);
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) {
        return false;
    }
    const char *const slave = ptsname(master_);
    (void)::unlink(link_.c_str());
    return slave != nullptr && make_raw(slave) && symlink(slave, link_.c_str()) == 0;
}

void BoardBus::restart_boards() {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (BoardFirmware &board : boards_) {
        board.restart();
    }
}

void BoardBus::damage(std::vector<std::uint8_t> &answer) {
    const auto draw = [this] {
        random_ = random_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(random_ >> 11) * 0x1p-53;
    };
    if (answer.empty()) {
        return;
    }
    const auto place = [&] {
        return answer.begin() +
               static_cast<std::ptrdiff_t>(draw() * static_cast<double>(answer.size()));
    };
    if (draw() < faults.lost_bytes.load()) {
        answer.erase(place());
    }
    if (draw() < faults.garbage.load() && !answer.empty()) {
        for (int i = static_cast<int>(30.0 * draw()); i >= 0; --i) {
            answer.insert(place(), static_cast<std::uint8_t>(256.0 * draw()));
        }
    }
    if (faults.silent.load()) {
        answer.clear();
    }
}

bool BoardBus::serve(std::vector<std::uint8_t> &answer) {
    std::array<std::uint8_t, 4096> bytes{};
    const ssize_t size = master_ >= 0 ? read(master_, bytes.data(), bytes.size()) : -1;
    if (size <= 0) {
        return false; // nothing, or no host has it open
    }
    seen_.heard_bytes += static_cast<std::uint64_t>(size);
    answer.clear();
    for (ssize_t i = 0; i < size; ++i) {
        for (BoardFirmware &board : boards_) {
            board.hear(bytes[static_cast<std::size_t>(i)], answer);
        }
    }
    damage(answer);
    if (!answer.empty()) {
        late_.push_back({monotonic_ns() + std::int64_t{faults.delay_us.load()} * 1000, answer});
    }
    return true;
}

void BoardBus::send_due(std::int64_t now_ns) {
    while (!late_.empty() && late_.front().due_ns <= now_ns) {
        const std::vector<std::uint8_t> &bytes = late_.front().bytes;
        if (master_ >= 0) {
            (void)!write(master_, bytes.data(), bytes.size());
        }
        late_.pop_front();
    }
}

void BoardBus::move_on(std::int64_t now_ns) {
    if (orders_box_.read(taken_)) {
        plant_.set_hand_target(taken_.target);
        plant_.set_hand_firmness(taken_.firmness);
        weight_.hang(taken_.hung_string, taken_.weight_n);
    }
    const std::int64_t step_ns = std::min(now_ns - moved_ns_, kLongestStep_ns);
    moved_ns_ = now_ns;
    StringArray currents_a{};
    std::size_t string = 0;
    seen_.strongest = 0;
    seen_.currents = 0;
    seen_.cut_replies = 0;
    seen_.flash_writes = 0;
    std::size_t place = 0;
    for (const BoardFirmware &board : boards_) {
        seen_.masks[place] = board.quadrature_mask;
        seen_.ids[place++] = board.flash_id();
        seen_.flash_writes += board.flash_writes();
        seen_.currents += board.executed(BoardCommand::current);
        seen_.cut_replies += board.cut_replies();
        for (std::size_t i = 0; i < board.layout().motors() && string < currents_a.size(); ++i) {
            const std::int64_t units = std::abs(std::int64_t{board.currents()[i]});
            seen_.strongest = std::max(seen_.strongest, units);
            currents_a[string++] = static_cast<double>(units) / settings_.units_per_a;
        }
    }
    seen_.strongest_ever = std::max(seen_.strongest_ever, seen_.strongest);
    seen_.last_pull_ns = seen_.strongest > 0 ? now_ns : seen_.last_pull_ns;
    double weighing_a = 0.0;
    if (weight_.hangs()) { // its motor no longer pulls the grip
        std::swap(weighing_a, currents_a[static_cast<std::size_t>(weight_.string())]);
    }
    plant_.set_currents(currents_a);
    plant_.advance(static_cast<double>(step_ns) * 1e-9);
    CountArray counts = plant_.counts();
    if (weight_.hangs()) {
        const auto i = static_cast<std::size_t>(weight_.string());
        weight_.advance(weighing_a * newtons_per_ampere_[i], static_cast<double>(step_ns) * 1e-9);
        counts[i] -= static_cast<std::int32_t>(
            std::lround(weight_.height_m() / settings_.plant.metres_per_count));
    }
    string = 0;
    for (BoardFirmware &board : boards_) {
        for (std::size_t i = 0; i < board.layout().motors() && string < counts.size(); ++i) {
            const double counts_s = step_ns > 0 ? (counts[string] - counts_[string]) * 1e9 /
                                                      static_cast<double>(step_ns)
                                                : 0.0;
            board.turn(i, counts[string], counts_s);
            ++string;
        }
    }
    counts_ = counts;
    News news{seen_, counts, plant_.truth()};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        news.counts[i] -= home_[i];
    }
    news_.write(news);
}

void BoardBus::run() {
    name_thread("board_bus");
    (void)request_real_time();
    std::vector<std::uint8_t> answer;
    while (!stop_.load()) {
        const std::int64_t now_ns = monotonic_ns();
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            (void)serve(answer);
            send_due(monotonic_ns());
            move_on(now_ns);
        }
        sleep_until_ns(now_ns + kTick_ns);
    }
}

} // namespace spidar::test
