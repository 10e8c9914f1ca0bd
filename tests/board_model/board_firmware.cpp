#include "board_model/board_firmware.h"

#include <algorithm>
#include <cmath>

#include "device/serial/protocol/board_codec.h"

namespace spidar::test {

namespace {

constexpr unsigned kFirstNoCommand = 0x60;

// The others count by interrupt.
bool has_hardware_counter(std::size_t motor) {
    return motor == 0 || motor == 1 || motor == 7;
}

} // namespace

BoardFirmware::BoardFirmware(const BoardLayout &layout) : layout_(layout), flash_id_(layout.id) {
    restart();
}

void BoardFirmware::restart() {
    layout_.id = flash_id_;
    for (auto &lengths : lengths_) {
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            lengths[i] =
                static_cast<std::uint8_t>(command_length(layout_, static_cast<BoardCommand>(i)));
        }
    }
    origin_ = turned_;
    counts_ = {};
    losses_ = {};
    currents_ = {};
    fifo_.clear();
    command_.clear();
    reply_.clear();
    left_ = 0;
    replied_ = 0;
    parameter_ = 0;
}

void BoardFirmware::turn(std::size_t motor, std::int32_t count, double counts_s) {
    if (!has_hardware_counter(motor) && std::abs(counts_s) > sure_counts_s) {
        losses_[motor] += lost_share * (count - turned_[motor]);
    }
    turned_[motor] = count;
    if ((quadrature_mask >> motor & 1U) != 0) {
        counts_[motor] = count - origin_[motor] - static_cast<std::int32_t>(losses_[motor]);
        speeds_[motor] =
            static_cast<std::int16_t>(std::lround(counts_s / layout_.control_rate_hz()));
    }
}

void BoardFirmware::hear(std::uint8_t byte, std::vector<std::uint8_t> &answer) {
    fifo_.push_back(byte);
    if (fifo_.size() < kInterrupt) {
        return;
    }
    for (const std::uint8_t one : fifo_) {
        process(one, answer);
    }
    fifo_.clear();
}

void BoardFirmware::process(std::uint8_t byte, std::vector<std::uint8_t> &answer) {
    if (replied_ < reply_.size()) { // each byte that comes in clocks one out
        answer.push_back(reply_[replied_++]);
    }
    if (left_ == 0) {
        begin(byte);
    } else {
        command_.push_back(byte);
        --left_;
    }
    if (left_ == 0 && !command_.empty()) {
        execute();
        command_.clear();
    }
}

void BoardFirmware::begin(std::uint8_t header) {
    if (header == 0 || header >= kFirstNoCommand) {
        return;
    }
    const std::uint8_t id = header & 7U;
    const std::size_t command = header >> 3U;
    command_.assign(1, header);
    left_ = std::max<std::size_t>(lengths_[id][command], 1) - 1;
    if (id == layout_.id) {
        cut_replies_ += replied_ < reply_.size() ? 1U : 0U;
        prepare_reply(static_cast<BoardCommand>(command));
    }
}

void BoardFirmware::append(std::int16_t word) {
    const auto bits = static_cast<std::uint16_t>(word);
    reply_.push_back(static_cast<std::uint8_t>(bits & 0xFFU));
    reply_.push_back(static_cast<std::uint8_t>(bits >> 8U));
}

// Before the command itself is read: what it asks for is not known yet.
void BoardFirmware::prepare_reply(BoardCommand command) {
    reply_.clear();
    replied_ = 0;
    const std::size_t length = reply_length(layout_, command);
    if (length == 0) {
        return;
    }
    reply_.push_back(board_header(command, layout_.id));
    const BoardInfo &info = layout_.info;
    switch (command) {
    case BoardCommand::info:
        reply_.insert(reply_.end(), {info.model, info.targets, info.motors, info.currents,
                                     info.forces, info.touches});
        break;
    case BoardCommand::current:
        for (std::size_t i = 0; i < layout_.motors(); ++i) {
            append(static_cast<std::int16_t>(counts_[i]));
        }
        for (std::size_t i = 0; i < layout_.motors(); ++i) {
            append(speeds_[i]);
        }
        break;
    case BoardCommand::get_parameter:
        reply_.push_back(parameter_);
        if (parameter_ == static_cast<std::uint8_t>(BoardParameter::board_id)) {
            reply_.push_back(flash_id_);
        } else if (parameter_ == static_cast<std::uint8_t>(BoardParameter::quadrature_mask)) {
            for (unsigned shift = 0; shift < 32; shift += 8) {
                reply_.push_back(static_cast<std::uint8_t>(quadrature_mask >> shift & 0xFFU));
            }
        }
        break;
    default:
        break;
    }
    reply_.resize(length, 0);
}

void BoardFirmware::execute() {
    const std::uint8_t id = command_[0] & 7U;
    const auto command = static_cast<BoardCommand>(command_[0] >> 3U);
    if (command == BoardCommand::set_command_lengths) { // for every board to know
        std::copy_n(command_.begin() + 1, std::min(command_.size() - 1, lengths_[id].size()),
                    lengths_[id].begin());
        ++executed_[static_cast<std::size_t>(command)];
        return;
    }
    if (id != layout_.id) {
        return;
    }
    ++executed_[static_cast<std::size_t>(command)];
    if (command == BoardCommand::current) {
        for (std::size_t i = 0; i < layout_.motors(); ++i) {
            currents_[i] = static_cast<std::int16_t>(
                static_cast<std::uint16_t>(command_[1 + 2 * i] | command_[2 + 2 * i] << 8U));
        }
    } else if (command == BoardCommand::get_parameter) {
        parameter_ = command_[1];
    } else if (command == BoardCommand::set_parameter) {
        set_parameter();
    }
}

void BoardFirmware::set_parameter() {
    const auto parameter = static_cast<BoardParameter>(command_[1]);
    flash_writes_ += parameter != BoardParameter::torque_limits ? 1U : 0U;
    if (forgets) {
        return;
    }
    if (parameter == BoardParameter::quadrature_mask) {
        quadrature_mask = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            quadrature_mask |= std::uint32_t{command_[2 + i]} << 8U * i;
        }
    } else if (parameter == BoardParameter::board_id) {
        flash_id_ = command_[2] & 7U;
        layout_.id = id_counts_at_once ? flash_id_ : layout_.id;
    }
}

} // namespace spidar::test
