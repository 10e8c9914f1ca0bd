#include "device/simulation/simulated_transport.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/simulation/simulated_link.h"
#include "device/threads/triple_buffer.h"

namespace spidar {

namespace {

constexpr double kMostSqueeze_rad = 3.2; // largest angle in a sensor's 16 bits

// From the controlling thread to the device thread.
struct Orders {
    HandTarget target;
    std::uint32_t target_number = 0;
    HandFirmness firmness = HandFirmness::normal;
    std::uint32_t firmness_number = 0;
    std::uint8_t buttons = 0;
    FaultList faults{};
};

// From the device thread to the controlling thread.
struct News {
    PlantTruth truth;
    std::array<std::uint32_t, kMaxFaults> finished{};
};

CountArray ideal_home_counts(PlantSettings settings) noexcept {
    settings.length_offset_error_m = {};
    settings.length_gain_error = {};
    return SimulatedPlant(settings).counts(); // a new plant is at the rest pose
}

} // namespace

struct SimulatedTransport::Impl {
    explicit Impl(const PlantSettings &settings)
        : settings_valid(validate(settings).empty()), rigid(settings.grip.kind == GripKind::rigid),
          metres_per_count(settings_valid ? settings.metres_per_count : kPaperMetresPerCount),
          plant(settings_valid ? settings : PlantSettings{}),
          home_counts(ideal_home_counts(settings_valid ? settings : PlantSettings{})),
          held_counts(plant.counts()) {
        link.configure(settings_valid ? settings : PlantSettings{});
        news.truth = plant.truth();
    }

    // Nothing pulls, and commands in transit are lost.
    void lose_power() noexcept {
        commanded_a = {};
        written = false;
        link.cut();
    }
    void take_orders() noexcept;
    void move_on(double dt_s, const ActiveFaults &faults) noexcept;
    void make_report() noexcept;
    void publish() noexcept {
        news_mailbox.write({plant.truth(), schedule.finished(plant.time_s())});
    }

    const bool settings_valid;
    const bool rigid;
    const double metres_per_count;

    // Used by the device thread.
    SimulatedPlant plant;
    const CountArray home_counts;
    SimulatedLink link;
    FaultSchedule schedule;
    Orders received;
    StringArray commanded_a{}; // arrived at the device
    bool written = false;      // something was sent since the last advance()
    StringArray sent_a{};
    CountArray turned_at{};                  // counts at which encoders were reversed
    std::array<bool, kStringCount> turned{}; // reversed encoders
    CountArray count_base{};                 // origin of the counts since the device restarted
    double clock_base_s = 0.0;
    bool was_reset = false;
    DeviceReading made;     // the report before the faults of the link
    CountArray held_counts; // counts of a frozen encoder
    DeviceReading report;
    bool report_is_new = false;
    bool is_open = false;

    // Used by the controlling thread.
    Orders orders;
    News news;
    std::uint32_t last_fault_number = 0;

    TripleBuffer<Orders> orders_mailbox;
    TripleBuffer<News> news_mailbox;
};

void SimulatedTransport::Impl::take_orders() noexcept {
    Orders next = received;
    if (!orders_mailbox.read(next)) {
        return;
    }
    if (next.target_number != received.target_number) {
        plant.set_hand_target(next.target);
    }
    if (next.firmness_number != received.firmness_number) {
        plant.set_hand_firmness(next.firmness);
    }
    schedule.set(next.faults, plant.time_s());
    received = next;
}

void SimulatedTransport::Impl::make_report() noexcept {
    const ActiveFaults faults = schedule.at(plant.time_s());
    const CountArray counts = plant.counts();
    const bool restarts = faults.has(SimulatedFault::counts_reset);
    if (restarts && !was_reset) {
        count_base = counts;
        clock_base_s = plant.time_s();
        made.sequence = 0;
    }
    was_reset = restarts;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool reversed = faults.has(SimulatedFault::reversed_encoder, i);
        if (reversed && !turned[i]) {
            turned_at[i] = counts[i];
        }
        turned[i] = reversed;
        const bool stuck = faults.has(SimulatedFault::frozen_counts) ||
                           faults.has(SimulatedFault::stuck_encoder, i);
        held_counts[i] = stuck ? held_counts[i] : counts[i];
        std::int32_t count = held_counts[i];
        count = reversed ? 2 * turned_at[i] - count : count;
        count += static_cast<std::int32_t>(std::lround(faults.slip_m[i] / metres_per_count));
        made.counts[i] =
            count - count_base[i] + (faults.has(SimulatedFault::count_jump, i) ? kCountJump : 0);
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (faults.has(SimulatedFault::swapped_encoders, i)) {
            std::swap(made.counts[i], made.counts[(i + 1) % kStringCount]);
        }
    }
    made.device_time_us =
        static_cast<std::uint64_t>(std::llround((plant.time_s() - clock_base_s) * 1e6));
    ++made.sequence;
    made.buttons = received.buttons;
    if (rigid) {
        made.sensors[kSqueezeSensor] = static_cast<std::int16_t>(
            std::lround(kSqueeze_1_rad * std::clamp(received.target.grasp_angle_rad,
                                                    -kMostSqueeze_rad, kMostSqueeze_rad)));
    }
    report = made;
    report_is_new = link.deliver(report, faults);
}

// Advances the plant; currents act when they arrive.
void SimulatedTransport::Impl::move_on(double dt_s, const ActiveFaults &faults) noexcept {
    double left_s = dt_s;
    const double end_s = plant.time_s() + dt_s;
    if (written) {
        link.send(sent_a, plant.time_s(),
                  faults.has(SimulatedFault::late_output) ? kLateOutput_s : 0.0);
        written = false;
    }
    // The link holds at most this many commands, so that the loop ends.
    for (std::size_t arrivals = 0; arrivals < SimulatedLink::kMostOnTheWay && link.next_s() < end_s;
         ++arrivals) {
        const double wait_s = link.next_s() - plant.time_s();
        const StringArray arrived_a = link.receive();
        if (wait_s > 0.0) {
            plant.advance(wait_s);
            left_s -= wait_s;
        }
        commanded_a = faults.has(SimulatedFault::blocked_output) ? commanded_a : arrived_a;
        plant.set_currents(faults.has(SimulatedFault::output_cut) ? StringArray{} : commanded_a);
    }
    plant.advance(left_s);
}

SimulatedTransport::SimulatedTransport(const PlantSettings &settings)
    : impl_(std::make_unique<Impl>(settings)) {}

SimulatedTransport::~SimulatedTransport() {
    close();
}

Status SimulatedTransport::open() noexcept {
    Impl &m = *impl_;
    if (!m.settings_valid) {
        return Status::invalid_settings;
    }
    m.take_orders();
    if (m.schedule.at(m.plant.time_s()).has(SimulatedFault::unplugged)) {
        return Status::open_failed;
    }
    m.is_open = true;
    m.make_report();
    m.publish();
    return Status::ok;
}

void SimulatedTransport::close() noexcept {
    impl_->lose_power();
    impl_->plant.set_currents({});
    impl_->report_is_new = false;
    impl_->is_open = false;
}

Status SimulatedTransport::read(DeviceReading &reading) noexcept {
    Impl &m = *impl_;
    if (!m.is_open) {
        return Status::not_open;
    }
    m.take_orders();
    const ActiveFaults faults = m.schedule.at(m.plant.time_s());
    if (faults.has(SimulatedFault::unplugged)) {
        return Status::read_failed;
    }
    if (faults.has(SimulatedFault::read_timeout) || !m.report_is_new) {
        return Status::read_timeout;
    }
    m.report_is_new = false;
    reading = m.report;
    return Status::ok;
}

Status SimulatedTransport::write(const DriveCommand &command) noexcept {
    Impl &m = *impl_;
    if (!m.is_open) {
        return Status::not_open;
    }
    if (m.schedule.at(m.plant.time_s()).has(SimulatedFault::unplugged)) {
        m.lose_power();
        return Status::write_failed;
    }
    m.sent_a = command.motors_on ? command.currents_a : StringArray{};
    m.written = true;
    return Status::ok;
}

void SimulatedTransport::advance(double dt_s) noexcept {
    Impl &m = *impl_;
    m.take_orders();
    const ActiveFaults faults = m.schedule.at(m.plant.time_s());
    m.plant.set_broken_strings(faults.mask(SimulatedFault::broken_string));
    m.plant.set_jammed_strings(faults.mask(SimulatedFault::jammed_drum));
    m.plant.set_hand_released(faults.has(SimulatedFault::hand_released));
    if (faults.has(SimulatedFault::unplugged)) {
        m.lose_power(); // power returns with the next write, not with the plug
    }
    m.plant.set_currents(faults.has(SimulatedFault::output_cut) ? StringArray{} : m.commanded_a);
    m.move_on(dt_s, faults);
    m.make_report();
    m.publish();
}

CountArray SimulatedTransport::home_counts() const noexcept {
    return impl_->home_counts;
}

void SimulatedTransport::set_hand_target(const HandTarget &target) noexcept {
    if (!is_usable(target)) {
        return;
    }
    impl_->orders.target = target;
    ++impl_->orders.target_number;
    impl_->orders_mailbox.write(impl_->orders);
}

void SimulatedTransport::set_buttons(std::uint8_t buttons) noexcept {
    impl_->orders.buttons = buttons;
    impl_->orders_mailbox.write(impl_->orders);
}

void SimulatedTransport::set_hand_firmness(HandFirmness firmness) noexcept {
    impl_->orders.firmness = firmness;
    ++impl_->orders.firmness_number;
    impl_->orders_mailbox.write(impl_->orders);
}

bool SimulatedTransport::inject(const FaultInjection &fault) noexcept {
    Impl &m = *impl_;
    if (!is_usable(fault)) {
        return false;
    }
    m.news_mailbox.read(m.news);
    for (std::size_t i = 0; i < m.orders.faults.size(); ++i) {
        NumberedFault &place = m.orders.faults[i];
        if (place.number == 0 || place.number == m.news.finished[i]) {
            place = {++m.last_fault_number, fault};
            m.orders_mailbox.write(m.orders);
            return true;
        }
    }
    return false;
}

void SimulatedTransport::clear_faults() noexcept {
    impl_->orders.faults = {};
    impl_->orders_mailbox.write(impl_->orders);
}

PlantTruth SimulatedTransport::truth() noexcept {
    impl_->news_mailbox.read(impl_->news);
    return impl_->news.truth;
}

} // namespace spidar
