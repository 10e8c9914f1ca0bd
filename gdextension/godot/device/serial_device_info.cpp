#include "godot/device/serial_device_info.h"

#include "device/contract/device_claims.h"
#include "device/serial/board_talk.h"
#include "device/serial/serial_port.h"
#include "godot/base/type_conversions.h"

namespace spidar {

std::string serial_boards_text(const SerialTransport &transport) {
    std::string text;
    for (const BoardLayout &board : transport.boards()) {
        text += (text.empty() ? "" : ", ") + name_of(board);
    }
    return text;
}

void describe_serial(const SerialTransport &transport, double rate_hz, godot::Dictionary &info) {
    const SerialCounters count = transport.counters();
    info["product"] = to_godot(serial_boards_text(transport));
    info["path"] = to_godot(transport.port());
    info["remarks"] = to_godot(transport.remarks());
    info["latency_s"] = transport.latency_s(rate_hz);
    info["highest_rate_hz"] = transport.highest_rate_hz();
    info["reports"] = whole(count.rounds);
    info["reports_lost"] = whole(count.lost);
    info["reports_refused"] = whole(count.implausible + count.damaged + count.unasked);
    info["garbage_bytes"] = whole(count.garbage_bytes);
    info["commands"] = whole(count.asked);
    info["commands_skipped"] = whole(count.postponed);
    info["unplugged"] = whole(count.losses);
    info["found_again"] = whole(count.replugs);
    info["guard_trips"] = whole(count.guard_trips);
    info["guard_losses"] = whole(count.guard_losses);
}

void list_serial_ports(godot::Array &list) {
    for (const SerialPortInfo &port : list_serial_ports()) {
        if (!port.usb) {
            continue; // ports of the computer itself carry no boards
        }
        godot::Dictionary shown;
        shown["kind"] = "serial";
        shown["product"] = to_godot(port.product);
        shown["serial"] = to_godot(port.serial);
        shown["path"] = to_godot(port.path);
        shown["owner"] = to_godot(DeviceClaim::owner_of(serial_device_name(port.path)));
        list.push_back(shown);
    }
}

} // namespace spidar
