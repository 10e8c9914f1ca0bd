// A node on serial motor boards.
#include <godot_cpp/variant/utility_functions.hpp>

#include "device/serial/serial_port.h"
#include "godot/base/type_conversions.h"
#include "godot/device/spidar_g.h"

using spidar::Status;

std::unique_ptr<spidar::Transport> SpidarG::serial_transport(Status &status, std::string &problem) {
    spidar::SerialTransportSettings settings = config_or_default().serial_settings();
    status = spidar::choose_serial_port(settings.port, settings.port, problem);
    if (!spidar::usable(status)) {
        problem = "SpidarGConfig.serial_port: " + problem;
        return nullptr;
    }
    const std::string name = spidar::serial_device_name(settings.port);
    if (!claim_.take(name, name_for_messages())) {
        status = Status::device_in_use;
        problem = "Port " + settings.port + " belongs to SpidarG \"" +
                  spidar::DeviceClaim::owner_of(name) + "\".";
        return nullptr;
    }
    auto transport = std::make_unique<spidar::SerialTransport>(settings);
    status = transport->open();
    if (!spidar::usable(status)) {
        problem = transport->problem();
        claim_.release();
        return nullptr;
    }
    serial_ = transport.get();
    use_strings({},
                plant_.metres_per_count); // counts are 0 at the home pose, once it was zeroed there
    tell_choice("transport = Serial.");
    if (const std::string remarks = transport->remarks(); !remarks.empty()) {
        godot::UtilityFunctions::push_warning(named(remarks));
    }
    if (transport->highest_rate_hz() < settings_.rate_hz) {
        godot::UtilityFunctions::push_warning(
            named("the wire lets its boards be asked " +
                  std::to_string(static_cast<int>(transport->highest_rate_hz())) +
                  " times a second, fewer than SpidarGConfig.rate_hz."));
    }
    return transport;
}

std::string SpidarG::serial_boards_text() const {
    std::string text;
    for (const spidar::BoardLayout &board : serial_->boards()) {
        text += (text.empty() ? "" : ", ") + std::string(spidar::name_of_model(board.info.model)) +
                " with id " + std::to_string(board.id);
    }
    return text;
}

void SpidarG::describe_serial(godot::Dictionary &info) const {
    const spidar::SerialCounters count = serial_->counters();
    info["product"] = spidar::to_godot(serial_boards_text());
    info["path"] = spidar::to_godot(serial_->port());
    info["remarks"] = spidar::to_godot(serial_->remarks());
    info["highest_rate_hz"] = serial_->highest_rate_hz();
    info["reports"] = spidar::whole(count.rounds);
    info["reports_lost"] = spidar::whole(count.lost);
    info["reports_refused"] = spidar::whole(count.implausible + count.damaged + count.unasked);
    info["garbage_bytes"] = spidar::whole(count.garbage_bytes);
    info["commands"] = spidar::whole(count.asked);
    info["commands_skipped"] = spidar::whole(count.postponed);
    info["unplugged"] = spidar::whole(count.losses);
    info["found_again"] = spidar::whole(count.replugs);
    info["guard_trips"] = spidar::whole(count.guard_trips);
    info["guard_losses"] = spidar::whole(count.guard_losses);
}

void SpidarG::list_serial_ports(godot::Array &list) {
    for (const spidar::SerialPortInfo &port : spidar::list_serial_ports()) {
        if (!port.usb) {
            continue; // no board is on a port of the computer's own
        }
        godot::Dictionary shown;
        shown["kind"] = "serial";
        shown["product"] = spidar::to_godot(port.product);
        shown["serial"] = spidar::to_godot(port.serial);
        shown["path"] = spidar::to_godot(port.path);
        shown["owner"] =
            spidar::to_godot(spidar::DeviceClaim::owner_of(spidar::serial_device_name(port.path)));
        list.push_back(shown);
    }
}
