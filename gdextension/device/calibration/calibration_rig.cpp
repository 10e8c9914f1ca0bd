#include "device/calibration/calibration_rig.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "device/calibration/fault_clearing.h"
#include "device/safety/monitors/thermal_budget.h"
#include "device/safety/motor_heat.h"
#include "device/safety/safety_gate.h"
#include "device/settings/servo_settings.h"
#include "device/simulation/simulated_transport.h"
#include "device/threads/real_time_thread.h"
#include "device/threads/spsc_ring.h"
#include "device/threads/triple_buffer.h"
#include "device/threads/writer_thread.h"

namespace spidar {

namespace {

constexpr double kLongestAdvance_s = 60.0;
constexpr std::int64_t kNanoseconds = 1'000'000'000;
// Delay after which a late thread restarts its time base, and the task of a real device ends: the
// lengths it saw are too old to continue pulling.
constexpr std::int64_t kGiveUpLag_ns = 50'000'000;
// Shortest cycle, as a share of the period; a shorter one is an early wake-up.
constexpr double kShortestCyclePart = 0.25;
// Silence after which a device cannot pull.
constexpr double kSilent_s = 0.1;
// Distance (unit: m) and speed (unit: m/s) below which the simulated grip has arrived at a place.
constexpr double kArrived_m = 0.002;
constexpr double kStill_m_s = 0.001;

} // namespace

struct CalibrationRig::Impl {
    RigSettings settings;
    MakeTransport make_transport;
    std::unique_ptr<Transport> transport;
    std::unique_ptr<WriterThread> writer; // threaded loops with a transport whose write may block
    SimulatedTransport *simulated = nullptr; // the transport, when it is one
    CalibrationTasks tasks;
    SafetyGate gate;
    ThermalBudget heat;
    DeviceReading reading;
    bool has_reading = false;
    double since_report_s = 0.0;
    double since_beat_s = 0.0;
    double since_sample_s = 0.0;
    double script_time_s = 0.0;
    FaultClearing clearing;
    RigOrders orders;
    RigNews news;

    std::thread thread;
    std::atomic<bool> close_asked{false};
    std::atomic<RigState> state{RigState::closed};
    std::string problem; // written before state becomes failed or closed
    TripleBuffer<RigOrders> orders_box;
    TripleBuffer<RigNews> news_box;
    SpscRing<CountArray> samples{kWaitingSamples};

    bool open() noexcept;
    void shut() noexcept;
    bool keep_heat() noexcept; // false: there is no memory for it
    void cycle(double dt_s) noexcept;
    void take_orders(double dt_s) noexcept;
    void move_hand(double dt_s) noexcept;
    void drive(double dt_s) noexcept;
    void keep_sample(double dt_s) noexcept;
    void stop_task(TaskVerdict verdict) noexcept;
    Status write(const DriveCommand &command) noexcept;
    // Threaded: stops a task when the device accepts no commands or this thread was late.
    void watch_writer() noexcept;
    bool start_writer() noexcept;
    void run() noexcept;
    void run_cycles() noexcept;
};

bool CalibrationRig::Impl::open() noexcept {
    try {
        transport = make_transport(problem);
        if (transport) {
            const Status status = transport->open();
            if (!usable(status)) {
                problem = problem.empty() ? describe(status) : problem;
                transport.reset();
            } else {
                heat.configure(SafetySettings());
                heat.set_heat(recall_motor_heat(transport->device_name(), monotonic_ns()));
            }
        }
    } catch (const std::exception &error) { // no memory, no thread
        transport.reset();
        problem = error.what();
    }
    simulated = dynamic_cast<SimulatedTransport *>(transport.get());
    StringArray limit;
    limit.fill(std::fmin(settings.max_tension_n, kTaskMaxTension_n));
    gate.configure(limit, kTaskSlew_n_per_ms);
    state.store(transport ? RigState::open : RigState::failed, std::memory_order_release);
    return transport != nullptr;
}

bool CalibrationRig::Impl::keep_heat() noexcept {
    try {
        keep_motor_heat(transport->device_name(), heat.heat(), SafetySettings().thermal_time_s,
                        monotonic_ns());
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

void CalibrationRig::Impl::shut() noexcept {
    if (transport) {
        (void)keep_heat();
        if (writer) {
            writer->stop(); // motors off
            writer.reset();
        } else {
            transport->write({});
        }
        transport->close();
        transport.reset();
        simulated = nullptr;
    }
    if (state.load(std::memory_order_relaxed) != RigState::failed) {
        state.store(RigState::closed, std::memory_order_release);
    }
}

void CalibrationRig::Impl::cycle(double dt_s) noexcept {
    take_orders(dt_s);
    if (writer) {
        watch_writer();
    }
    since_report_s += dt_s;
    const bool was_lost = news.status == Status::read_failed;
    news.status = transport->read(reading);
    news.losses += news.status == Status::read_failed && !was_lost ? 1U : 0U;
    if (usable(news.status)) {
        has_reading = true;
        since_report_s = 0.0;
        news.counts = reading.counts;
        news.device_status = reading.device_status;
        ++news.readings;
        keep_sample(dt_s);
    }
    drive(dt_s);
    move_hand(dt_s);
    transport->advance(dt_s);
    news.time_s += dt_s;
    news_box.write(news);
}

void CalibrationRig::Impl::take_orders(double dt_s) noexcept {
    RigOrders next = orders;
    since_beat_s += dt_s;
    if (orders_box.read(next)) {
        since_beat_s = next.beat != orders.beat ? 0.0 : since_beat_s;
        script_time_s = next.hand_number != orders.hand_number ? 0.0 : script_time_s;
        orders = next;
    }
    const double limit_s = simulated != nullptr ? settings.simulated_unwatched_s : kUnwatched_s;
    if (!(since_beat_s < limit_s)) {
        tasks.abort(TaskVerdict::stopped);
    }
}

// Switches off at once, without slew limit.
void CalibrationRig::Impl::stop_task(TaskVerdict verdict) noexcept {
    tasks.abort(verdict);
    gate.shut();
}

void CalibrationRig::Impl::watch_writer() noexcept {
    if (writer->take_stalled()) {
        stop_task(TaskVerdict::stopped);
    }
    if (writer->blocked_ns(monotonic_ns()) > WriterThread::kBlockedForGood_ns) {
        stop_task(TaskVerdict::not_ready);
    }
}

Status CalibrationRig::Impl::write(const DriveCommand &command) noexcept {
    if (!writer) {
        return transport->write(command);
    }
    writer->post(command);
    if (!command.motors_on) {
        writer->allow(); // after it had stopped the motors itself
    }
    return writer->take_result();
}

void CalibrationRig::Impl::drive(double dt_s) noexcept {
    TaskInput input;
    input.dt_s = dt_s;
    input.device_ready = has_reading && since_report_s < kSilent_s && usable(reading.device_status);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        input.lengths_m[i] = settings.scale_m_per_count[i] * reading.counts[i];
    }
    PlantTruth truth;
    if (simulated != nullptr) {
        truth = simulated->truth();
        input.true_tensions_n = &truth.tensions_n;
        news.simulated = true;
        news.true_lengths_m = truth.lengths_m;
        const Vec3 off = truth.pose.position_m - calibration_hand(settings.plant, orders.hand,
                                                                  orders.hand_place, script_time_s)
                                                     .position_m;
        news.hand_has_arrived =
            glm::dot(off, off) < kArrived_m * kArrived_m &&
            glm::dot(truth.twist.linear_m_s, truth.twist.linear_m_s) < kStill_m_s * kStill_m_s;
    }
    StringArray wanted_n = tasks.step(orders.task, input);
    if (heat.is_spent() && tasks.active()) {
        stop_task(TaskVerdict::too_warm);
        wanted_n = {};
    }
    const TaskVerdict verdict = tasks.result().verdict;
    if (verdict == TaskVerdict::moved_too_fast || verdict == TaskVerdict::stopped ||
        verdict == TaskVerdict::not_ready) {
        gate.shut();
    }
    const SafetyGate::Output output = gate.pass(wanted_n, dt_s);
    heat.spend(output.tensions_n, dt_s);
    DriveCommand command;
    command.tensions_n = output.tensions_n;
    command.currents_a = currents_from_tensions(settings.motors, output.tensions_n);
    bool pulling = tasks.active();
    for (const double tension : output.tensions_n) {
        pulling = pulling || tension > 0.0;
    }
    command.motors_on = pulling;
    command.clear_faults =
        clearing.step(orders.task.number, usable(reading.device_status)) && !pulling;
    const Status written = write(command);
    if (pulling && !usable(written)) {
        stop_task(TaskVerdict::not_ready);
    }
    news.motors_on = pulling;
    news.tensions_n = output.tensions_n;
    news.task = tasks.result();
}

void CalibrationRig::Impl::move_hand(double dt_s) noexcept {
    script_time_s += dt_s;
    if (simulated != nullptr) {
        simulated->set_hand_target(
            calibration_hand(settings.plant, orders.hand, orders.hand_place, script_time_s));
    }
}

void CalibrationRig::Impl::keep_sample(double dt_s) noexcept {
    since_sample_s += dt_s;
    if (!orders.collecting || since_sample_s < kSampleInterval_s) {
        return;
    }
    if (samples.offer(reading.counts)) { // full: nobody reads it
        since_sample_s = 0.0;
    }
}

bool CalibrationRig::Impl::start_writer() noexcept {
    if (!transport->write_may_block()) {
        return true;
    }
    writer = std::make_unique<WriterThread>(*transport);
    if (usable(writer->start())) {
        return true;
    }
    writer.reset();
    problem = "The system cannot start another thread; close other programs.";
    state.store(RigState::failed, std::memory_order_release);
    return false;
}

void CalibrationRig::Impl::run() noexcept {
    name_thread("spidar_rig");
    (void)request_real_time(); // the writer thread would take a late rig for a stalled one
    if (open() && start_writer()) {
        run_cycles();
    }
    shut();
}

void CalibrationRig::Impl::run_cycles() noexcept {
    const double period_s = 1.0 / settings.rate_hz;
    const auto period_ns = static_cast<std::int64_t>(static_cast<double>(kNanoseconds) * period_s);
    const FlushDenormals flush;
    std::int64_t last_ns = monotonic_ns();
    std::int64_t next_ns = last_ns + period_ns;
    while (!close_asked.load(std::memory_order_acquire)) {
        sleep_until_ns(next_ns);
        const std::int64_t now_ns = monotonic_ns();
        const std::int64_t passed_ns = now_ns - last_ns;
        last_ns = now_ns;
        if (simulated != nullptr) {
            cycle(period_s); // its time is the thread's own
        } else {
            if (passed_ns > kGiveUpLag_ns) {
                stop_task(TaskVerdict::stopped);
            }
            const double passed_s =
                static_cast<double>(passed_ns) / static_cast<double>(kNanoseconds);
            cycle(std::fmax(passed_s, kShortestCyclePart * period_s));
        }
        next_ns += period_ns;
        if (monotonic_ns() - next_ns > kGiveUpLag_ns) {
            next_ns = monotonic_ns();
        }
    }
}

CalibrationRig::CalibrationRig(const RigSettings &settings, MakeTransport make_transport)
    : impl_(std::make_unique<Impl>()) {
    impl_->settings = settings;
    impl_->make_transport = std::move(make_transport);
}

CalibrationRig::~CalibrationRig() {
    ask_close();
    if (impl_->thread.joinable()) {
        impl_->thread.join();
    }
    impl_->shut();
}

bool CalibrationRig::start_threaded() {
    impl_->state.store(RigState::opening, std::memory_order_relaxed);
    try {
        impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
    } catch (const std::system_error &error) {
        impl_->problem = error.what();
        impl_->state.store(RigState::failed, std::memory_order_relaxed);
        return false;
    }
    return true;
}

void CalibrationRig::start_stepped() {
    impl_->open();
}

void CalibrationRig::advance(double seconds) noexcept {
    if (impl_->thread.joinable() || state() != RigState::open || !(seconds > 0.0)) {
        return;
    }
    const FlushDenormals flush;
    const double period_s = 1.0 / impl_->settings.rate_hz;
    const auto cycles = std::lround(std::fmin(seconds, kLongestAdvance_s) / period_s);
    for (long i = 0; i < cycles; ++i) {
        impl_->cycle(period_s);
    }
}

void CalibrationRig::ask_close() noexcept {
    impl_->close_asked.store(true, std::memory_order_release);
    if (!impl_->thread.joinable()) {
        impl_->shut();
    }
}

RigState CalibrationRig::state() const noexcept {
    return impl_->state.load(std::memory_order_acquire);
}

std::string CalibrationRig::problem() const {
    return state() == RigState::failed ? impl_->problem : std::string();
}

void CalibrationRig::give(const RigOrders &orders) noexcept {
    impl_->orders_box.write(orders);
}

bool CalibrationRig::latest(RigNews &news) noexcept {
    return impl_->news_box.read(news);
}

bool CalibrationRig::next_sample(CountArray &counts) noexcept {
    return impl_->samples.take(counts);
}

} // namespace spidar
