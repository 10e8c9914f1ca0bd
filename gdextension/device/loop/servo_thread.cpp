#include "device/loop/servo_thread.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

// Shortest time step of a real device, as a share of the period; a shorter one is an early wake-up.
constexpr double kShortestStepPart = 0.25;
// Time for which a thread that waits to open a device may delay a stop().
constexpr std::int64_t kNap_ns = 20'000'000;

std::int64_t nanoseconds(double time_s) noexcept {
    return static_cast<std::int64_t>(std::llround(time_s * 1e9));
}

double seconds(std::int64_t time_ns) noexcept {
    return static_cast<double>(time_ns) * 1e-9;
}

} // namespace

Status ServoThread::start(const ServoSettings &settings, Status open_status) noexcept {
    period_s_ = 1.0 / settings.rate_hz;
    reopen_interval_s_ = settings.reopen_interval_s;
    open_status_ = open_status;
    stop_asked_.store(false, std::memory_order_relaxed);
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error &) {
        return Status::open_failed;
    }
    return Status::ok;
}

void ServoThread::stop() noexcept {
    stop_asked_.store(true, std::memory_order_release);
    thread_.join();
    cycle_began_ns_.store(0, std::memory_order_release);
}

double ServoThread::since_last_cycle_s() const noexcept {
    const std::int64_t began_ns = cycle_began_ns_.load(std::memory_order_acquire);
    return began_ns != 0 ? seconds(monotonic_ns() - began_ns) : 0.0;
}

void ServoThread::run() noexcept {
    const FlushDenormals flush;
    name_thread("spidar_servo");
    const bool real_time = request_real_time();
    timing_.set_real_time_priority(real_time);
    if (usable(open_status_) || open_patiently()) {
        cycle_.recall_heat();
        if (!real_time) {
            cycle_.host_events().tell(DeviceEventKind::no_real_time_priority);
        }
        run_cycles();
    }
    cycle_.source().motors_off();
}

bool ServoThread::open_patiently() noexcept {
    cycle_.show_open_failed(open_status_);
    while (!usable(open_status_)) {
        const std::int64_t next_ns = monotonic_ns() + nanoseconds(reopen_interval_s_);
        for (std::int64_t now_ns = monotonic_ns(); now_ns < next_ns; now_ns = monotonic_ns()) {
            if (stop_asked_.load(std::memory_order_acquire)) {
                return false;
            }
            sleep_until_ns(std::min(next_ns, now_ns + kNap_ns));
        }
        open_status_ = cycle_.source().open();
    }
    return true;
}

void ServoThread::run_cycles() noexcept {
    CycleSource &source = cycle_.source();
    const std::int64_t period_ns = nanoseconds(period_s_);
    const auto shortest_ns = nanoseconds(kShortestStepPart * period_s_);
    const bool simulated = source.simulated();
    bool clocked = false;
    std::int64_t last_ns = monotonic_ns();
    std::int64_t deadline_ns = last_ns + period_ns;
    timing_.begin(last_ns);
    while (!stop_asked_.load(std::memory_order_acquire)) {
        // A device that streams is the clock: a cycle begins with its report, or half a period
        // after the report was due.
        if (clocked) { // however fast it streams
            sleep_until_ns(last_ns + shortest_ns);
        }
        clocked = source.wait_report(deadline_ns + period_ns / 2);
        if (!clocked) {
            sleep_until_ns(deadline_ns);
        }
        const std::int64_t woken_ns = monotonic_ns();
        cycle_began_ns_.store(woken_ns, std::memory_order_release);
        if (timing_.woken(woken_ns - deadline_ns)) {
            cycle_.host_events().tell(DeviceEventKind::cycles_late, -1,
                                      seconds(woken_ns - deadline_ns));
        }
        deadline_ns = clocked ? woken_ns : deadline_ns;
        // A step longer than the longest means that the computer slept; the step receives the true
        // time.
        const double step_s = std::max(seconds(woken_ns - last_ns), kShortestStepPart * period_s_);
        last_ns = woken_ns;
        cycle_.run(simulated ? period_s_ : step_s);
        const std::int64_t done_ns = monotonic_ns();
        timing_.cycle_ended(woken_ns, done_ns);

        deadline_ns += period_ns;
        if (done_ns > deadline_ns) { // skip missed cycles; catching up would only cause a jerk
            const std::int64_t missed = (done_ns - deadline_ns) / period_ns + 1;
            timing_.missed(missed);
            deadline_ns += missed * period_ns;
        }
    }
}

} // namespace spidar
