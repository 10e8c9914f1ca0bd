// Selection of the node's device (a real one behind USB HID, or the simulated one), and functions
// of real devices.
#include "godot/device/spidar_g.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/input_event_joypad_button.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "device/hid/open_free_device.h"
#include "godot/base/type_conversions.h"
#include "godot/device/serial_device_info.h"
#include "godot/settings/plugged_in_devices.h"

using godot::String;
using godot::UtilityFunctions;
using spidar::Status;

namespace {

constexpr double kMilli = 1e-3;
constexpr double kPerMilli = 1e3;
constexpr int kButtons = 8;
// Interval at which a device that does not open is tried again.
constexpr std::chrono::milliseconds kTryAgain(1000);

[[nodiscard]] std::uint16_t to_millis(double value) {
    constexpr double kMost = 65535.0;
    return static_cast<std::uint16_t>(std::lround(std::clamp(value * kPerMilli, 0.0, kMost)));
}

} // namespace

spidar::HidTransportSettings SpidarG::hid_settings() const {
    spidar::HidTransportSettings settings;
    settings.filter = config_or_default().hid_filter();
    settings.limits.max_tension_mn = to_millis(settings_.tension.max_tension_n);
    settings.limits.min_tension_mn = to_millis(settings_.tension.min_tension_n);
    settings.limits.tension_rate_mn_ms = to_millis(settings_.safety.tension_slew_n_per_ms);
    settings.limits.string_speed_mm_s = to_millis(settings_.safety.max_count_speed_m_s);
    return settings;
}

std::unique_ptr<spidar::Transport> SpidarG::choose_transport(Status &status, std::string &problem) {
    using Choice = SpidarGConfig::Transport;
    auto choice = static_cast<Choice>(config_or_default().get_transport());
    if (choice == Choice::TRANSPORT_AUTOMATIC && !options_.use_hardware) {
        choice = Choice::TRANSPORT_SIMULATED;
    }
    fallback_.clear();
    tried_.clear();
    const bool serial = choice == Choice::TRANSPORT_SERIAL;
    if ((choice == Choice::TRANSPORT_DEVICE || serial) && drive_mode_ == DRIVE_STEPPED) {
        status = Status::invalid_settings;
        problem = "SpidarGConfig.transport = " + std::string(serial ? "Serial" : "Device") +
                  " with drive_mode = Stepped: only a simulated device can run in simulated time. "
                  "Set drive_mode to Threaded.";
        return nullptr;
    }
    if (serial) {
        return serial_transport(status, problem);
    }
    if (choice != Choice::TRANSPORT_SIMULATED && drive_mode_ != DRIVE_STEPPED) {
        // Listed before opening: devices that appear later are new to the watch.
        (void)spidar::find_devices(*spidar::system_hid_bus(), config_or_default().hid_filter(),
                                   tried_);
        auto transport = spidar::open_free_device(spidar::system_hid_bus(), hid_settings(),
                                                  name_for_messages(), claim_, status, problem);
        if (transport) {
            hid_ = transport.get();
            // Counts are 0 at the home pose, and the device reports its counts per turn.
            use_strings({}, spidar::metres_per_count(hid_->capabilities().counts_per_turn,
                                                     settings_.motors.effective_radius_m[0],
                                                     plant_.metres_per_count));
            tell_choice("transport = " +
                        std::string(choice == Choice::TRANSPORT_DEVICE ? "Device" : "Automatic") +
                        ", and this device is the first that matches and is free.");
            return transport;
        }
        if (status == Status::invalid_settings) {
            problem = "SpidarGConfig." + problem;
        }
        if (choice == Choice::TRANSPORT_DEVICE) {
            return nullptr;
        }
        // Having no device is normal during development: no error, and no advice on cables.
        fallback_ = status == Status::no_device ? "No matching SPIDAR-G is plugged in." : problem;
        if (status != Status::no_device) {
            UtilityFunctions::push_warning(named("the simulated device is used. " + problem));
        }
    }
    auto transport = simulated_transport(status, problem);
    if (transport) {
        tell_choice(why_simulated());
    }
    return transport;
}

std::string SpidarG::why_simulated() const {
    if (!fallback_.empty()) {
        return fallback_ + " If a device is plugged in now, it is opened within a second.";
    }
    if (config_or_default().get_transport() == SpidarGConfig::TRANSPORT_SIMULATED) {
        return "SpidarGConfig.transport = Simulated.";
    }
    return drive_mode_ == DRIVE_STEPPED
               ? "drive_mode = Stepped: only a simulated device can run in simulated time."
               : "The project setting spidar_g/device/use_hardware is off.";
}

String SpidarG::get_device_text() const {
    if (simulated_ != nullptr) {
        return "Simulated device.";
    }
    if (hid_ != nullptr) {
        const spidar::HidDeviceInfo device = hid_->device();
        return spidar::to_godot(
            "Real device \"" + device.product + "\"" +
            (device.serial.empty() ? ", no serial number" : ", serial " + device.serial) + ", " +
            device.path + ".");
    }
    if (serial_ != nullptr) {
        return spidar::to_godot("Serial device: " + spidar::serial_boards_text(*serial_) + ", " +
                                serial_->device_name() + ".");
    }
    return replay_ != nullptr ? "Replay of a recording." : "No device is open.";
}

// Deferred to the end of this frame, after the scene's _ready().
void SpidarG::tell_choice(const std::string &reason) {
    const String device = get_device_text();
    UtilityFunctions::print(named("") + device + String(" ") + spidar::to_godot(reason));
    call_deferred("emit_signal", "device_chosen", is_simulated(), device, spidar::to_godot(reason));
}

void SpidarG::watch_for_devices() {
    if (simulated_ != nullptr && !fallback_.empty()) {
        hid_watch_ = std::make_unique<spidar::HidWatch>(spidar::system_hid_bus(),
                                                        config_or_default().hid_filter(), tried_);
    } else if (!loop_ && looks_for_serial() && !serial_search_) {
        serial_search_ = std::make_unique<spidar::SerialSearch>(
            config_or_default().serial_settings(), name_for_messages());
    } else if (!loop_ && config_or_default().get_transport() == SpidarGConfig::TRANSPORT_DEVICE &&
               drive_mode_ != DRIVE_STEPPED) {
        // No device was opened. Devices that were tried count as new too, since their access rights
        // may change.
        hid_watch_ = std::make_unique<spidar::HidWatch>(
            spidar::system_hid_bus(), config_or_default().hid_filter(),
            std::vector<spidar::HidDeviceInfo>{}, kTryAgain);
    }
}

godot::Array SpidarG::list_devices() {
    godot::Array list;
    for (const spidar::HidDeviceInfo &device : spidar::plugged_in_devices()) {
        godot::Dictionary shown;
        shown["kind"] = "hid";
        shown["product"] = spidar::to_godot(device.product);
        shown["serial"] = spidar::to_godot(device.serial);
        shown["path"] = spidar::to_godot(device.path);
        shown["vendor_id"] = static_cast<int>(device.vendor_id);
        shown["product_id"] = static_cast<int>(device.product_id);
        shown["owner"] =
            spidar::to_godot(spidar::DeviceClaim::owner_of(spidar::claim_name(device)));
        list.push_back(shown);
    }
    spidar::list_serial_ports(list);
    return list;
}

void SpidarG::use_strings(const spidar::CountArray &home_counts, double metres_per_count) {
    // read_resources() found no problem in the calibration.
    (void)SpidarGCalibration::strings_of(calibration_, settings_.frame, settings_.grip, home_counts,
                                         metres_per_count, settings_.strings);
}

bool SpidarG::zero_device() {
    if (hid_ == nullptr) {
        return reject(
            "zero_device: the open device is not a USB device. A simulated device always knows "
            "its zero; for motor boards call zero_at_home().");
    }
    const spidar::StringArray home_m =
        spidar::string_lengths(settings_.frame, settings_.grip, spidar::rest_pose(settings_.grip));
    const spidar::StringCalibration &strings = settings_.strings;
    spidar::CountArray home{};
    for (std::size_t i = 0; i < home.size(); ++i) {
        const double turns = (home_m[i] - strings.offset_m[i]) / strings.scale_m_per_count[i];
        home[i] = strings.zero_count[i] + static_cast<std::int32_t>(std::lround(turns));
    }
    const Status status = hid_->zero(home);
    if (!spidar::usable(status)) {
        return reject(
            "zero_device: the device did not accept the command. It must be plugged in and its "
            "motors must be off: call disarm() first.");
    }
    return true;
}

godot::Dictionary SpidarG::get_device_info() const {
    godot::Dictionary info;
    const bool real = hid_ != nullptr;
    info["simulated"] = simulated_ != nullptr;
    info["fallback_reason"] = spidar::to_godot(fallback_);
    const spidar::HidDeviceInfo device = real ? hid_->device() : spidar::HidDeviceInfo{};
    info["product"] = spidar::to_godot(device.product);
    info["serial"] = spidar::to_godot(device.serial);
    info["path"] = spidar::to_godot(device.path);
    if (serial_ != nullptr) {
        spidar::describe_serial(*serial_, settings_.rate_hz, info);
    }
    if (!real) {
        return info;
    }
    const spidar::HidCapabilities spec = hid_->capabilities();
    info["firmware_version"] = static_cast<std::int64_t>(spec.firmware_version);
    info["max_tension_n"] = kMilli * hid_->limits().max_tension_mn;
    info["max_force_n"] = kMilli * spec.max_force_mn;
    info["max_moment_nm"] = kMilli * spec.max_moment_mnm;
    info["max_grasp_torque_nm"] = kMilli * spec.max_grasp_torque_mnm;
    info["max_stiffness_n_m"] = static_cast<double>(spec.max_stiffness_n_m);
    info["workspace_m"] = spidar::to_godot(
        kMilli * spidar::Vec3(spec.workspace_mm[0], spec.workspace_mm[1], spec.workspace_mm[2]));
    const spidar::HidCounters count = hid_->counters();
    const spidar::HidTimes times = hid_->times();
    info["reports"] = spidar::whole(count.reports);
    info["reports_lost"] = spidar::whole(count.lost);
    info["reports_refused"] = spidar::whole(count.wrong_length + count.corrupt + count.replayed +
                                            count.out_of_order + count.implausible + count.stale);
    info["commands"] = spidar::whole(count.commands);
    info["commands_skipped"] = spidar::whole(count.skipped_commands);
    info["unplugged"] = spidar::whole(count.losses);
    info["found_again"] = spidar::whole(count.replugs);
    info["round_trip_p50_us"] = times.round_trip_p50_us;
    info["round_trip_p99_us"] = times.round_trip_p99_us;
    info["latency_s"] = hid_->latency_s();
    info["write_p99_us"] = times.write_p99_us;
    return info;
}

void SpidarG::mask_buttons(const spidar::ServoSnapshot &before) {
    if (before.state == spidar::DeviceState::closed) {
        stale_buttons_ = snapshot_.buttons;
    }
    stale_buttons_ = static_cast<std::uint8_t>(stale_buttons_ & snapshot_.buttons);
    snapshot_.buttons = static_cast<std::uint8_t>(snapshot_.buttons & ~stale_buttons_);
}

void SpidarG::emit_buttons(std::uint8_t before) {
    const std::uint8_t now = snapshot_.buttons;
    for (int button = 0; button < kButtons && now != before; ++button) {
        const bool pressed = ((now >> button) & 1) != 0;
        if (pressed == (((before >> button) & 1) != 0)) {
            continue;
        }
        godot::Ref<godot::InputEventJoypadButton> event;
        event.instantiate();
        event->set_device(config_or_default().get_button_device());
        event->set_button_index(static_cast<godot::JoyButton>(button));
        event->set_pressed(pressed);
        godot::Input::get_singleton()->parse_input_event(event);
        emit_signal("button_changed", button, pressed);
    }
}

bool SpidarG::set_simulated_buttons(int mask) {
    if (simulated_ == nullptr) {
        return false;
    }
    if (mask < 0 || mask > 255) {
        return reject("set_simulated_buttons: mask = " + std::to_string(mask) +
                      ": give 0 to 255, one bit per button.");
    }
    simulated_->set_buttons(static_cast<std::uint8_t>(mask));
    return true;
}
