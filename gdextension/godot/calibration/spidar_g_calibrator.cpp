// SpidarGCalibrator: opens and watches the device and runs the calibration's tasks.
#include "godot/calibration/spidar_g_calibrator.h"

#include <godot_cpp/variant/utility_functions.hpp>

#include <algorithm>
#include <cmath>

#include "device/simulation/simulated_transport.h"
#include "godot/base/type_conversions.h"

using spidar::RigState;

static_assert(static_cast<int>(RigState::failed) == SpidarGCalibrator::DEVICE_FAILED);
static_assert(static_cast<int>(spidar::CalibrationTask::weighing) ==
              SpidarGCalibrator::TASK_WEIGHING);
static_assert(static_cast<int>(spidar::TaskVerdict::too_warm) ==
              SpidarGCalibrator::VERDICT_TOO_WARM);
static_assert(static_cast<int>(spidar::HandScript::place) == SpidarGCalibrator::HAND_PLACE);

namespace {

// Limits of a real device during calibration (unit: mN, mN/ms, mm/s).
constexpr std::uint16_t kMilliPerUnit = 1000;
constexpr double kSimulatedUnwatched_s = 20.0;

} // namespace

SpidarGCalibrator::~SpidarGCalibrator() = default;

bool SpidarGCalibrator::open(const godot::Ref<SpidarGConfig> &config,
                             const godot::Ref<SpidarGCalibration> &calibration, bool stepped) {
    if (rig_ && rig_->state() != RigState::closed && rig_->state() != RigState::failed) {
        return reject(
            "open: the device is already open or still closing: call close() and wait for "
            "DEVICE_CLOSED.");
    }
    if (board_job_) {
        return reject("open: the boards' parameters are being read or written: wait until "
                      "is_using_boards() is false.");
    }
    problem_ = read_target(config, calibration);
    if (!problem_.empty()) {
        return false;
    }
    if (stepped && !target_.try_simulated) {
        return reject(
            "open: stepped = true with transport = Device or Serial: only a simulated device can "
            "run in simulated time.");
    }
    target_.try_hid = target_.try_hid && !stepped;
    opened_ = std::make_shared<spidar::CalibrationOpened>();
    began_ = false;
    has_result_ = false;
    news_ = {};
    orders_ = {};
    task_taken_ = 0;
    spidar::RigSettings settings;
    settings.rate_hz = 1000.0;
    settings.scale_m_per_count = start_.strings.scale_m_per_count;
    settings.motors = motors_;
    settings.plant = target_.plant;
    settings.simulated_unwatched_s = kSimulatedUnwatched_s;
    rig_ = std::make_unique<spidar::CalibrationRig>(
        settings, [target = target_, opened = opened_](std::string &problem) {
            return spidar::open_for_calibration(target, *opened, problem);
        });
    if (stepped) {
        rig_->start_stepped();
        rig_->advance(1.0 / settings.rate_hz); // the first reading
    } else if (!rig_->start_threaded()) {
        return reject("open: the system cannot start another thread. " + rig_->problem());
    }
    const bool polled = poll();
    return polled || !stepped; // a failure to open is reported by a later poll()
}

std::string SpidarGCalibrator::read_target(const godot::Ref<SpidarGConfig> &config,
                                           const godot::Ref<SpidarGCalibration> &calibration) {
    godot::Ref<SpidarGConfig> used = config;
    if (used.is_null()) {
        used.instantiate();
    }
    std::string problem = used->own_problem();
    if (!problem.empty()) {
        return problem;
    }
    spidar::ServoSettings settings = used->servo_settings();
    const spidar::PlantSettings plant = used->plant_settings();
    given_ = calibration;
    problem = given_.is_valid() ? given_->apply_to(settings) : std::string();
    problem = problem.empty() ? spidar::validate(settings) : problem;
    problem = problem.empty() ? spidar::validate(plant) : problem;
    if (!problem.empty()) {
        return problem;
    }
    const int transport = used->get_transport();
    const bool automatic = transport == SpidarGConfig::TRANSPORT_AUTOMATIC;
    target_ = {};
    target_.try_hid = automatic || transport == SpidarGConfig::TRANSPORT_DEVICE;
    target_.try_serial = transport == SpidarGConfig::TRANSPORT_SERIAL;
    target_.try_simulated = automatic || transport == SpidarGConfig::TRANSPORT_SIMULATED;
    target_.serial = used->serial_settings();
    target_.plant = plant;
    target_.simulated_name = used->get_device_name().utf8().get_data();
    target_.hid.filter = used->hid_filter();
    target_.hid.limits.max_tension_mn =
        static_cast<std::uint16_t>(spidar::kTaskMaxTension_n * kMilliPerUnit);
    target_.hid.limits.min_tension_mn = 0; // a task pulls single strings
    start_.frame = settings.frame;
    start_.grip = settings.grip;
    start_.strings = settings.strings;
    corrections_ = settings.corrections;
    // The winding of the drums is kept; stretch is the same in all poses of a light hand.
    start_.corrections = {};
    start_.corrections.winding_curvature_1_m = corrections_.winding_curvature_1_m;
    motors_ = settings.motors;
    return {};
}

// Fills what the calibration leaves open with the ideal device of the opened kind. Returns false
// and closes the device when the calibration became unusable meanwhile.
bool SpidarGCalibrator::begin_sheet() {
    const double scale = spidar::metres_per_count(
        opened_->counts_per_turn, motors_.effective_radius_m[0], target_.plant.metres_per_count);
    const spidar::CountArray home = opened_->real
                                        ? spidar::CountArray{}
                                        : spidar::SimulatedTransport(target_.plant).home_counts();
    const std::string problem = SpidarGCalibration::strings_of(given_, start_.frame, start_.grip,
                                                               home, scale, start_.strings);
    given_.unref();
    if (!problem.empty()) {
        close();
        return reject(problem);
    }
    sheet_.begin(start_, motors_);
    began_ = true;
    model_changed_ = true;
    return true;
}

void SpidarGCalibrator::close() {
    if (rig_) {
        rig_->ask_close();
    }
    orders_.collecting = false;
}

bool SpidarGCalibrator::poll() {
    finish_job();
    finish_board_job();
    if (!rig_) {
        return false;
    }
    const RigState state = rig_->state();
    if (state == RigState::failed) {
        return reject(rig_->problem());
    }
    if (state == RigState::open && !began_ && !begin_sheet()) {
        return false;
    }
    if (state == RigState::closed && opened_) {
        opened_->claim.release();
    }
    if (!began_) {
        return true; // still opening
    }
    give();
    const std::uint32_t losses = news_.losses;
    rig_->latest(news_);
    if (news_.losses != losses && opened_->counts_restart) {
        forget_lost_counts();
    }
    fetch_samples();
    take_task_result();
    follow();
    return true;
}

// Readings from before the loss no longer fit those after it.
void SpidarGCalibrator::forget_lost_counts() {
    sheet_.clear_zero();
    for (std::size_t string = 0; string < spidar::kStringCount; ++string) {
        sheet_.clear_lengths(string);
    }
    clear_poses();
    refuse(
        "poll: the connection to the boards was lost for a moment, so their counts restarted. The "
        "zero, the lengths and the poses were discarded. Read the zero again.");
}

void SpidarGCalibrator::give() {
    ++orders_.beat;
    rig_->give(orders_);
}

bool SpidarGCalibrator::advance(double seconds) {
    if (!is_open()) {
        return reject("advance: no device is open: call open() first.");
    }
    constexpr double kSlice_s = 0.1; // each slice sends an order, so that the rig counts as watched
    if (!(seconds > 0.0 && seconds <= 60.0)) {
        return reject("advance: seconds = " + std::to_string(seconds) +
                      " s: give more than 0 s and up to 60 s.");
    }
    for (double left = seconds; left > 1e-9; left -= kSlice_s) {
        give();
        rig_->advance(std::fmin(left, kSlice_s));
    }
    return poll();
}

void SpidarGCalibrator::follow() {
    if (model_changed_) {
        const spidar::DeviceModel now = model();
        (void)kinematics_.configure(now.frame, now.grip);
        model_changed_ = false;
    }
    if (news_.readings > 0) {
        const spidar::DeviceModel now = model();
        live_lengths_m_ = spidar::wound_lengths(now.strings, now.corrections, news_.counts);
        live_ = kinematics_.update(live_lengths_m_);
    }
}

void SpidarGCalibrator::fetch_samples() {
    spidar::CountArray counts{};
    while (rig_->next_sample(counts)) {
        sheet_.add_pose(counts);
    }
}

void SpidarGCalibrator::take_task_result() {
    const spidar::TaskResult &task = news_.task;
    if (task.number == task_taken_ || task.number != orders_.task.number ||
        task.verdict == spidar::TaskVerdict::running) {
        return;
    }
    task_taken_ = task.number;
    const auto string = static_cast<std::size_t>(std::clamp(task.string, 0, 7));
    const spidar::CalibrationTask kind = orders_.task.task;
    if (kind == spidar::CalibrationTask::wiring) {
        const bool sound = task.verdict == spidar::TaskVerdict::done;
        if (sound || task.verdict == spidar::TaskVerdict::wrong_sign) {
            sheet_.set_reversed(string, !sound);
            model_changed_ = true;
        }
    }
    if (kind == spidar::CalibrationTask::weighing && task.verdict == spidar::TaskVerdict::done) {
        const std::string problem =
            sheet_.add_weight(string, {orders_.task.weight_n, task.rise_n, task.fall_n});
        if (!problem.empty()) {
            reject(problem);
        }
    }
}

SpidarGCalibrator::DeviceState SpidarGCalibrator::get_device_state() const {
    return rig_ ? static_cast<DeviceState>(rig_->state()) : DEVICE_CLOSED;
}

godot::String SpidarGCalibrator::get_problem() const {
    return spidar::to_godot(problem_);
}

bool SpidarGCalibrator::is_open() const {
    return rig_ && rig_->state() == RigState::open && began_;
}

void SpidarGCalibrator::refuse(const std::string &message) const {
    problem_ = message;
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGCalibrator." + message));
}

bool SpidarGCalibrator::reject(const std::string &message) {
    problem_ = message;
    return false;
}

bool SpidarGCalibrator::start_task(Task task, int string, double weight_n) {
    if (!is_open()) {
        return reject("start_task: no device is open: call open() first.");
    }
    const bool of_a_string = task == TASK_WIRING || task == TASK_WEIGHING;
    if (task < TASK_IDLE || task > TASK_WEIGHING ||
        (of_a_string && (string < 0 || string >= spidar::kStringCount))) {
        return reject("start_task: task = " + std::to_string(static_cast<int>(task)) +
                      ", string = " + std::to_string(string) +
                      ": give one of Task and a string index from 0 to 7.");
    }
    if (task == TASK_WEIGHING &&
        !(weight_n >= spidar::kLeastWeight_n && weight_n <= spidar::kMostWeight_n)) {
        return reject("start_task: weight_n = " + std::to_string(weight_n) + " N: hang " +
                      std::to_string(spidar::kLeastWeight_n) + " to " +
                      std::to_string(spidar::kMostWeight_n) + " N on the string.");
    }
    problem_.clear();
    orders_.task = {static_cast<spidar::CalibrationTask>(task), string, weight_n,
                    orders_.task.number + 1};
    give();
    return true;
}

bool SpidarGCalibrator::move_simulated_hand(Hand hand, int place) {
    if (!is_open() || !news_.simulated) {
        return false; // a real hand moves by itself
    }
    if (hand < HAND_HOME || hand > HAND_PLACE || place < 0 || place >= spidar::kHandPlaces) {
        return reject("move_simulated_hand: hand = " + std::to_string(static_cast<int>(hand)) +
                      ", place = " + std::to_string(place) +
                      ": give one of Hand and a place from 0 to 7.");
    }
    orders_.hand = static_cast<spidar::HandScript>(hand);
    orders_.hand_place = place;
    ++orders_.hand_number;
    news_.hand_has_arrived = false;
    give();
    return true;
}

godot::Dictionary SpidarGCalibrator::get_live() const {
    godot::Dictionary live;
    live["readings"] = static_cast<std::int64_t>(news_.readings);
    live["simulated"] = news_.simulated;
    live["fallback_reason"] = spidar::to_godot(opened_ && began_ ? opened_->fallback : "");
    live["remarks"] = spidar::to_godot(opened_ && began_ ? opened_->remarks : "");
    live["counts"] = spidar::to_godot(news_.counts);
    live["lengths_m"] = spidar::to_godot(live_lengths_m_);
    live["tensions_n"] = spidar::to_godot(news_.tensions_n);
    live["motors_on"] = news_.motors_on;
    live["position_m"] = spidar::to_godot(live_.pose.position_m);
    live["residual_m"] = live_.residual_rms_m;
    live["conditioning"] = live_.conditioning;
    live["pose_status"] = static_cast<int>(live_.status);
    live["pose_text"] = godot::String(spidar::describe(live_.status));
    live["device_status"] = static_cast<int>(news_.device_status);
    live["device_text"] = godot::String(spidar::describe(news_.device_status));
    live["hand_has_arrived"] = news_.hand_has_arrived;
    if (news_.simulated) {
        live["ruler_m"] = spidar::to_godot(news_.true_lengths_m);
    }
    return live;
}

godot::Dictionary SpidarGCalibrator::get_task() const {
    godot::Dictionary told;
    const spidar::TaskResult &task = news_.task;
    const bool waiting = task.number != orders_.task.number && is_open();
    const auto verdict = waiting ? spidar::TaskVerdict::running : task.verdict;
    told["task"] = static_cast<int>(orders_.task.task);
    told["verdict"] = static_cast<int>(verdict);
    told["text"] = godot::String(spidar::describe(verdict));
    told["string"] = orders_.task.string;
    told["moved_string"] = task.moved_string;
    told["moved_m"] = spidar::to_godot(task.moved_m);
    told["rise_n"] = task.rise_n;
    told["fall_n"] = task.fall_n;
    return told;
}
