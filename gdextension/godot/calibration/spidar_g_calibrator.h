// SpidarGCalibrator: opens a device for calibration only, without a SpidarG node, and makes a
// SpidarGCalibration from the measurements. The class reference is
// gdextension/doc_classes/SpidarGCalibrator.xml.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/dictionary.hpp>

#include "core/calibration/fit/worksheet.h"
#include "core/kinematics/forward_kinematics.h"
#include "device/calibration/calibration_rig.h"
#include "device/serial/board_flash.h"
#include "godot/calibration/calibration_transport.h"
#include "godot/settings/spidar_g_calibration.h"
#include "godot/settings/spidar_g_config.h"

class SpidarGCalibrator : public godot::RefCounted {
    GDCLASS(SpidarGCalibrator, godot::RefCounted)
    SPIDAR_G_CHECKED_CALLS

public:
    enum DeviceState { DEVICE_CLOSED, DEVICE_OPENING, DEVICE_OPEN, DEVICE_FAILED };
    enum Task { TASK_IDLE, TASK_TAUT, TASK_WIRING, TASK_WEIGHING };
    enum Verdict {
        VERDICT_RUNNING,
        VERDICT_DONE,
        VERDICT_NO_MOVEMENT,
        VERDICT_WRONG_STRING,
        VERDICT_WRONG_SIGN,
        VERDICT_NOT_LIFTED,
        VERDICT_MOVED_TOO_FAST,
        VERDICT_STOPPED,
        VERDICT_NOT_READY,
        VERDICT_TOO_WARM
    };
    enum Hand { HAND_HOME, HAND_FREE_MOTION, HAND_PLACE };
    enum BoardParameter { PARAMETER_BOARD_ID = 3, PARAMETER_QUADRATURE_MASK = 7 };

    ~SpidarGCalibrator() override;

    // Reports a refused call, by get_problem() and in the output.
    void refuse(const std::string &message) const;

    // Device (spidar_g_calibrator.cpp).
    bool open(const godot::Ref<SpidarGConfig> &config,
              const godot::Ref<SpidarGCalibration> &calibration, bool stepped);
    void close();
    bool poll();
    bool advance(double seconds);
    [[nodiscard]] DeviceState get_device_state() const;
    [[nodiscard]] godot::String get_problem() const;
    [[nodiscard]] godot::Dictionary get_live() const;
    bool start_task(Task task, int string, double weight_n);
    [[nodiscard]] godot::Dictionary get_task() const;
    bool move_simulated_hand(Hand hand, int place);

    // Measurements and result (spidar_g_calibrator_results.cpp).
    bool take_zero();
    void clear_zero();
    [[nodiscard]] godot::Dictionary get_zero() const;
    bool take_length(int string, double length_m);
    void clear_lengths(int string);
    [[nodiscard]] godot::Dictionary get_lengths(int string) const;
    [[nodiscard]] godot::Dictionary get_weights(int string) const;
    void clear_weights(int string);
    [[nodiscard]] bool is_reversed(int string) const;
    void set_collecting(bool collecting);
    [[nodiscard]] bool is_collecting() const { return orders_.collecting; }
    void clear_poses();
    [[nodiscard]] godot::Dictionary get_coverage() const;
    bool compute();
    [[nodiscard]] bool is_computing() const { return job_ != nullptr; }
    [[nodiscard]] godot::Dictionary get_result() const;
    [[nodiscard]] godot::Ref<SpidarGCalibration> make_calibration();

    // Flash of serial motor boards (spidar_g_calibrator_boards.cpp).
    bool read_boards(const godot::Ref<SpidarGConfig> &config);
    [[nodiscard]] bool is_using_boards() const { return board_job_ != nullptr; }
    [[nodiscard]] godot::Array get_boards() const;
    godot::Dictionary propose_board_parameter(int board_id, BoardParameter parameter, int value);
    bool write_board_parameter(const godot::String &board);
    [[nodiscard]] godot::Dictionary get_board_result() const;

protected:
    static void _bind_methods();

private:
    // The computation of a result, in a thread that works on copies. The results are valid once
    // `done` is set.
    struct Job {
        spidar::CalibrationWorksheet sheet;
        spidar::SelfCalibrationResult result;
        spidar::StringArray before_m{};
        spidar::StringArray after_m{};
        std::atomic<bool> done{false};
        std::thread thread;
        ~Job() {
            if (thread.joinable()) {
                thread.join();
            }
        }
    };

    // Reads the boards in a thread, or writes one number and reads it back.
    struct BoardJob {
        bool writes = false;
        std::string port;
        spidar::FlashChange change;
        std::vector<spidar::BoardFlash> boards; // result of reading
        spidar::BoardFlash after;               // result of writing
        spidar::Status status = spidar::Status::ok;
        std::string problem;
        std::atomic<bool> give_up{false};
        std::atomic<bool> done{false};
        std::thread thread;
        ~BoardJob() {
            give_up.store(true);
            if (thread.joinable()) {
                thread.join();
            }
        }
    };

    static void bind_device();
    static void bind_boards();
    bool start_board_job(std::unique_ptr<BoardJob> job);
    void finish_board_job();
    static void bind_measurements();

    std::string read_target(const godot::Ref<SpidarGConfig> &config,
                            const godot::Ref<SpidarGCalibration> &calibration);
    bool begin_sheet();
    void take_task_result();
    void forget_lost_counts();
    void fetch_samples();
    void finish_job();
    void follow();
    void give();
    bool reject(const std::string &message);
    [[nodiscard]] bool is_open() const;
    [[nodiscard]] spidar::DeviceModel model() const;
    [[nodiscard]] bool may_measure(const char *method, int string);

    mutable std::string problem_; // mutable: a refused call of a const method is reported too
    spidar::CalibrationTarget target_;
    spidar::DeviceModel start_;
    spidar::MotorCalibration motors_;
    // The calibration passed to open(), until the device is open.
    godot::Ref<SpidarGCalibration> given_;
    // Corrections of that calibration. make_calibration() keeps them.
    spidar::LengthCorrections corrections_;
    // True once sheet_ has been started for the open device.
    bool began_ = false;
    std::shared_ptr<spidar::CalibrationOpened> opened_;
    std::unique_ptr<spidar::CalibrationRig> rig_;
    spidar::RigOrders orders_;
    spidar::RigNews news_;
    std::uint32_t task_taken_ = 0;

    spidar::CalibrationWorksheet sheet_;
    std::unique_ptr<Job> job_;
    bool has_result_ = false;
    spidar::SelfCalibrationResult result_;
    spidar::StringArray before_m_{};
    spidar::StringArray after_m_{};

    std::unique_ptr<BoardJob> board_job_;
    std::string boards_port_; // the port from which boards_ were read
    std::vector<spidar::BoardFlash> boards_;
    bool is_proposed_ = false; // proposal_ is set, and write_board_parameter() may confirm it
    spidar::FlashChange proposal_;
    godot::Dictionary board_result_;

    spidar::ForwardKinematics kinematics_; // for the live view
    spidar::KinematicsResult live_;
    spidar::StringArray live_lengths_m_{};
    bool model_changed_ = true;
};

VARIANT_ENUM_CAST(SpidarGCalibrator::DeviceState);
VARIANT_ENUM_CAST(SpidarGCalibrator::Task);
VARIANT_ENUM_CAST(SpidarGCalibrator::Verdict);
VARIANT_ENUM_CAST(SpidarGCalibrator::Hand);
VARIANT_ENUM_CAST(SpidarGCalibrator::BoardParameter);
