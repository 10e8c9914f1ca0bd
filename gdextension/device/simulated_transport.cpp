#include "device/simulated_transport.h"

#include <algorithm>
#include <cmath>

#include "device/triple_buffer.h"

namespace spidar {

namespace {

// Controlling thread -> device thread.
struct Orders {
    HandTarget target;
    std::uint32_t target_number = 0;
    HandFirmness firmness = HandFirmness::normal;
    std::uint32_t firmness_number = 0;
    FaultList faults{};
};

// Device thread -> controlling thread.
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
        : settings_valid(validate(settings).empty()),
          plant(settings_valid ? settings : PlantSettings{}),
          home_counts(ideal_home_counts(settings_valid ? settings : PlantSettings{})),
          held_counts(plant.counts()) {
        news.truth = plant.truth();
    }

    void take_orders() noexcept;
    void make_report() noexcept;
    void publish() noexcept {
        news_mailbox.write({plant.truth(), schedule.finished(plant.time_s())});
    }

    const bool settings_valid;

    // Device thread.
    SimulatedPlant plant;
    const CountArray home_counts;
    FaultSchedule schedule;
    Orders received;
    StringArray commanded_a{};
    CountArray held_counts; // what a frozen encoder says
    DeviceReading report;
    bool report_is_new = false;
    bool is_open = false;

    // Controlling thread.
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
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool stuck = faults.frozen_counts || ((faults.stuck_mask >> i) & 1U) != 0;
        held_counts[i] = stuck ? held_counts[i] : counts[i];
        const bool jumped = ((faults.jumped_mask >> i) & 1U) != 0;
        report.counts[i] = held_counts[i] + (jumped ? kCountJump : 0);
    }
    report.device_time_us = static_cast<std::uint64_t>(std::llround(plant.time_s() * 1e6));
    ++report.sequence;
    report_is_new = true;
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
    if (m.schedule.at(m.plant.time_s()).unplugged) {
        return Status::open_failed;
    }
    m.is_open = true;
    m.make_report();
    m.publish();
    return Status::ok;
}

void SimulatedTransport::close() noexcept {
    impl_->commanded_a = {};
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
    if (faults.unplugged) {
        return Status::read_failed;
    }
    if (faults.read_timeout || !m.report_is_new) {
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
    if (m.schedule.at(m.plant.time_s()).unplugged) {
        m.commanded_a = {};
        return Status::write_failed;
    }
    m.commanded_a = command.motors_on ? command.currents_a : StringArray{};
    return Status::ok;
}

void SimulatedTransport::advance(double dt_s) noexcept {
    Impl &m = *impl_;
    m.take_orders();
    const ActiveFaults faults = m.schedule.at(m.plant.time_s());
    m.plant.set_broken_strings(faults.broken_mask);
    if (faults.unplugged) {
        m.commanded_a = {}; // power does not come back with the plug: the next write brings it
    }
    m.plant.set_currents(faults.output_cut ? StringArray{} : m.commanded_a);
    m.plant.advance(dt_s);
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
