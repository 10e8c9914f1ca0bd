// Flash of serial motor boards: shown, and changed by a proposal and its confirmation.
#include "godot/calibration/spidar_g_calibrator.h"

#include <system_error>
#include <utility>

#include "device/serial/serial_port.h"
#include "godot/base/type_conversions.h"

using godot::ClassDB;
using godot::D_METHOD;

bool SpidarGCalibrator::start_board_job(std::unique_ptr<BoardJob> job) {
    using spidar::RigState;
    if (board_job_) {
        return reject("The boards are already being read or written: wait until is_using_boards() "
                      "is false.");
    }
    if (rig_ && rig_->state() != RigState::closed && rig_->state() != RigState::failed) {
        return reject(
            "The boards' parameters can be read and written only while their motors cannot "
            "be armed: call close() and wait for DEVICE_CLOSED.");
    }
    board_job_ = std::move(job);
    is_proposed_ = false;
    const auto work = [one = board_job_.get()] {
        one->status = one->writes
                          ? spidar::write_board_flash(one->change, spidar::kBoardBaud, one->give_up,
                                                      one->after, one->problem)
                          : spidar::read_board_flash(one->port, spidar::kBoardBaud, one->give_up,
                                                     one->boards, one->problem);
        one->done.store(true, std::memory_order_release);
    };
    try {
        board_job_->thread = std::thread(work);
    } catch (const std::system_error &error) {
        board_job_.reset();
        return reject(std::string("The system cannot start another thread. ") + error.what());
    }
    problem_.clear();
    return true;
}

bool SpidarGCalibrator::read_boards(const godot::Ref<SpidarGConfig> &config) {
    if (config.is_null() || config->get_transport() != SpidarGConfig::TRANSPORT_SERIAL) {
        return reject(
            "read_boards: config.transport is not Serial, but only serial motor boards have "
            "such parameters: set it to Serial.");
    }
    auto job = std::make_unique<BoardJob>();
    std::string problem;
    if (!spidar::usable(
            spidar::choose_serial_port(config->serial_settings().port, job->port, problem))) {
        return reject("SpidarGConfig.serial_port: " + problem);
    }
    if (!start_board_job(std::move(job))) {
        return false;
    }
    boards_.clear();
    return true;
}

void SpidarGCalibrator::finish_board_job() {
    if (!board_job_ || !board_job_->done.load(std::memory_order_acquire)) {
        return;
    }
    const std::unique_ptr<BoardJob> job = std::move(board_job_);
    const bool good = spidar::usable(job->status);
    if (job->writes) {
        spidar::FlashChange found = job->change;
        found.board = job->after;
        board_result_["known"] = true;
        board_result_["written"] = good;
        board_result_["board"] = spidar::to_godot(spidar::exact_name(job->change));
        board_result_["text"] = spidar::to_godot(
            good ? spidar::exact_name(job->change) + ": " + spidar::describe(job->change) +
                       ". The value was read back and is equal. Switch the boards off and on."
                 : job->problem);
        board_result_["value_before"] = static_cast<int>(spidar::value_before(job->change));
        board_result_["value_wanted"] = static_cast<int>(job->change.value);
        board_result_["value_found"] = static_cast<int>(spidar::value_before(found));
        boards_.clear(); // outdated: they are read again before the next write
    } else {
        boards_port_ = job->port;
        boards_ = job->boards;
    }
    if (!good) {
        reject(job->problem);
    }
}

godot::Array SpidarGCalibrator::get_boards() const {
    godot::Array list;
    for (const spidar::BoardFlash &one : boards_) {
        godot::Dictionary shown;
        shown["id"] = static_cast<int>(one.board.id);
        shown["model"] = godot::String(spidar::name_of_model(one.board.info.model));
        shown["motors"] = static_cast<int>(one.board.info.motors);
        shown["stored_id"] = static_cast<int>(one.stored_id);
        shown["quadrature_mask"] = static_cast<int>(one.quadrature_mask);
        shown["board"] = spidar::to_godot(spidar::exact_name({boards_port_, one}));
        list.push_back(shown);
    }
    return list;
}

// Sends nothing to the board.
godot::Dictionary SpidarGCalibrator::propose_board_parameter(int board_id, BoardParameter parameter,
                                                             int value) {
    godot::Dictionary told;
    is_proposed_ = false;
    std::string problem =
        "board_id = " + std::to_string(board_id) +
        ": no board with this id was read: call read_boards() and choose one of get_boards().";
    for (const spidar::BoardFlash &one : boards_) {
        if (one.board.id == board_id) {
            proposal_ = {boards_port_, one, static_cast<spidar::BoardParameter>(parameter),
                         static_cast<std::uint32_t>(value)};
            problem = value < 0 ? "value = " + std::to_string(value) + ": give 0 or more."
                                : spidar::validate(proposal_, boards_);
        }
    }
    is_proposed_ = problem.empty() && !board_job_;
    told["allowed"] = is_proposed_;
    told["board"] = spidar::to_godot(is_proposed_ ? spidar::exact_name(proposal_) : std::string());
    told["text"] =
        spidar::to_godot(is_proposed_ ? spidar::exact_name(proposal_) + ": " +
                                            spidar::describe(proposal_) + ", in its flash."
                                      : problem);
    if (!is_proposed_) {
        reject("propose_board_parameter: " + problem);
    }
    return told;
}

bool SpidarGCalibrator::write_board_parameter(const godot::String &board) {
    if (!is_proposed_) {
        return reject(
            "write_board_parameter: nothing was proposed since the boards were read: call "
            "propose_board_parameter() first.");
    }
    const std::string name = spidar::exact_name(proposal_);
    if (std::string(board.utf8().get_data()) != name) {
        is_proposed_ = false;
        return reject("write_board_parameter: board = \"" + std::string(board.utf8().get_data()) +
                      "\" is not the board of the proposal, \"" + name +
                      "\". Nothing was written: call propose_board_parameter() again.");
    }
    auto job = std::make_unique<BoardJob>();
    job->writes = true;
    job->port = proposal_.port;
    job->change = proposal_;
    board_result_.clear();
    return start_board_job(std::move(job));
}

godot::Dictionary SpidarGCalibrator::get_board_result() const {
    godot::Dictionary told = board_result_.duplicate();
    if (!told.has("known")) {
        told["known"] = false;
    }
    return told;
}

void SpidarGCalibrator::bind_boards() {
    using Self = SpidarGCalibrator;
    spidar::bind_checked<&Self::read_boards, "", "read_boards", "config">();
    ClassDB::bind_method(D_METHOD("is_using_boards"), &Self::is_using_boards);
    ClassDB::bind_method(D_METHOD("get_boards"), &Self::get_boards);
    spidar::bind_checked<&Self::propose_board_parameter, "", "propose_board_parameter", "board_id",
                         "parameter", "value">();
    spidar::bind_checked<&Self::write_board_parameter, "", "write_board_parameter", "board">();
    ClassDB::bind_method(D_METHOD("get_board_result"), &Self::get_board_result);
}
