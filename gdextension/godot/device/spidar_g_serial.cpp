// Serial motor boards of a node.
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"
#include "godot/device/spidar_g.h"

using spidar::Status;

bool SpidarG::looks_for_serial() const {
    return config_or_default().get_transport() == SpidarGConfig::TRANSPORT_SERIAL &&
           drive_mode_ != DRIVE_STEPPED;
}

// Opens boards that the search has found; reports a new reason why it finds none.
void SpidarG::watch_serial_search() {
    if (!serial_search_ || restart_pending_) {
        return;
    }
    found_serial_ = serial_search_->take();
    if (found_serial_) {
        restart_pending_ = true;
        trying_again_ = true;
        return;
    }
    Status status = Status::ok;
    std::string problem;
    if (serial_search_->take_failure(status, problem)) {
        refuse_device(status, SpidarGConfig::told_of(problem), true);
    }
}

std::unique_ptr<spidar::Transport> SpidarG::serial_transport(Status &status, std::string &problem) {
    std::unique_ptr<spidar::SerialTransport> transport = std::move(found_serial_);
    if (!transport) {
        transport = spidar::open_serial_device(config_or_default().serial_settings(),
                                               name_for_messages(), claim_, status, problem);
    } else if (!claim_.take(transport->device_name(), name_for_messages())) {
        transport.reset(); // another node took it meanwhile; the search continues
        status = Status::device_in_use;
        problem = spidar::describe(status);
    }
    if (!transport) {
        problem = SpidarGConfig::told_of(problem);
        return nullptr;
    }
    serial_ = transport.get();
    use_strings({},
                plant_.metres_per_count); // counts are 0 at the home pose once zeroed there
    tell_choice("transport = Serial.");
    if (const std::string remarks = transport->remarks(); !remarks.empty()) {
        godot::UtilityFunctions::push_warning(named(remarks));
    }
    if (transport->highest_rate_hz() < settings_.rate_hz) {
        godot::UtilityFunctions::push_warning(
            named("the boards can be read only " +
                  std::to_string(static_cast<int>(transport->highest_rate_hz())) +
                  " times a second, which is less than SpidarGConfig.rate_hz. Lower rate_hz."));
    }
    return transport;
}
