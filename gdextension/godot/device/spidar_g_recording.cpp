// Recording of the servo loop, and replay of a recording in place of a device.
#include "godot/device/spidar_g.h"

#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "device/recording/replay.h"
#include "godot/base/physics_tick.h"
#include "godot/base/type_conversions.h"

using godot::String;
using spidar::Status;

namespace {

// Returns user:// and res:// paths as system paths, UTF-8.
[[nodiscard]] std::string system_path(const String &path) {
    return godot::ProjectSettings::get_singleton()->globalize_path(path).utf8().get_data();
}

} // namespace

bool SpidarG::start_recording(const String &path) {
    if (!loop_) {
        return reject("start_recording: no device is open. Add the node to the running scene and "
                      "set enabled to true.");
    }
    if (is_recording()) {
        return reject(
            "start_recording: a recording is already running: call stop_recording() first.");
    }
    const std::string place = system_path(path);
    if (!recording_place_.take(place, name_for_messages())) {
        return reject("start_recording: path = \"" + place + "\": the recording of node \"" +
                      spidar::RecordingPlace::owner_of(place) +
                      "\" uses this file. Give another path.");
    }
    const std::string problem = loop_->start_recording(place);
    if (!problem.empty()) {
        recording_place_.release();
        return reject("start_recording: " + problem);
    }
    return true;
}

void SpidarG::stop_recording() {
    if (!is_recording()) {
        return;
    }
    loop_->stop_recording();
    recording_place_.release();
    if (loop_->recording_statistics().failed) {
        tell_recording_failed();
    }
}

bool SpidarG::is_recording() const {
    return loop_ && loop_->recording();
}

godot::Dictionary SpidarG::get_recording_statistics() const {
    const spidar::RecorderStatistics recorded =
        loop_ ? loop_->recording_statistics() : spidar::RecorderStatistics{};
    godot::Dictionary statistics;
    statistics["cycles"] = static_cast<std::int64_t>(recorded.cycles);
    statistics["lost_cycles"] = static_cast<std::int64_t>(recorded.lost);
    statistics["bytes"] = static_cast<std::int64_t>(recorded.bytes);
    statistics["failed"] = recorded.failed;
    return statistics;
}

void SpidarG::tell_recording_failed() {
    const String text =
        named("the recording could not be written any further. Check whether the disk is full. "
              "The part that was written before can be read.");
    godot::UtilityFunctions::push_error(text);
    emit_signal("recording_failed", text);
}

bool SpidarG::start_replay(const String &path) {
    if (!may_run()) {
        return reject("start_replay: the node is not in the running scene or is not enabled: add "
                      "it to the scene and set enabled to true.");
    }
    const std::string place = system_path(path);
    const std::string problem = spidar::Replay().load(place);
    if (!problem.empty()) {
        return reject("start_replay: " + problem);
    }
    replay_path_ = place;
    open_device();
    return is_replaying();
}

void SpidarG::stop_replay() {
    if (replay_path_.empty()) {
        return;
    }
    replay_path_.clear();
    if (may_run()) {
        open_device();
    } else {
        close_device("The replay was stopped.");
    }
}

bool SpidarG::is_replaying() const {
    return replay_ != nullptr;
}

godot::Dictionary SpidarG::get_replay_statistics() const {
    const spidar::ReplayReport report =
        replay_ != nullptr ? replay_->report() : spidar::ReplayReport{};
    godot::Dictionary statistics;
    statistics["cycles"] = static_cast<std::int64_t>(report.cycles);
    statistics["differing_cycles"] = static_cast<std::int64_t>(report.differing);
    statistics["lost_cycles"] = static_cast<std::int64_t>(report.lost);
    statistics["finished"] = report.finished;
    statistics["poses_only"] = replay_ != nullptr && !replay_->why_poses_only().empty();
    return statistics;
}

void SpidarG::open_replay() {
    auto replay = std::make_unique<spidar::Replay>();
    const std::string problem = replay->load(replay_path_);
    if (!problem.empty()) {
        replay_path_.clear();
        refuse_to_open(Status::open_failed, problem);
        return;
    }
    if (!replay->why_poses_only().empty()) {
        godot::UtilityFunctions::push_warning(named(replay->why_poses_only()));
    }
    settings_ = replay->settings();
    requests_.clear();
    requests_.configure(settings_.safety.wrench_fade_s, settings_.safety.contacts_gone_s);
    replay_contacts_ = spidar::ReplayContacts();
    replay_touches_.forget();
    replay_ = replay.get();
    change_loop(std::make_unique<spidar::ServoLoop>(std::move(replay)));
    const Status status =
        loop_->start_stepped(settings_); // driven by the game's ticks: replay_tick()
    if (!spidar::usable(status)) {
        replay_ = nullptr;
        change_loop(nullptr);
        replay_path_.clear();
        refuse_to_open(status, spidar::describe(status));
        return;
    }
    replay_end_told_ = false;
    set_process_internal(true);
}

void SpidarG::replay_tick() {
    spidar::GameRead read;
    while (replay_ != nullptr && replay_->next_read(read)) { // a listener may stop the replay
        loop_->advance_to(read.tick);
        pull_snapshot(read.physics_tick, &read);
        if (read.physics_tick) {
            return;
        }
    }
    if (replay_ == nullptr) {
        return;
    }
    // The recorded game read no more: the rest runs in real time.
    loop_->advance(1, spidar::physics_ticks_per_second());
    pull_snapshot(true);
}

void SpidarG::watch_recordings() {
    if (is_recording() && loop_->recording_statistics().failed) {
        stop_recording();
    }
    if (replay_ == nullptr || replay_end_told_ || !replay_->report().finished) {
        return;
    }
    replay_end_told_ = true;
    const spidar::ReplayReport report = replay_->report();
    const std::string damage = replay_->damage();
    std::string message = std::to_string(report.cycles) + " cycles replayed";
    const std::string &poses_only = replay_->why_poses_only();
    if (report.differing != 0) {
        message += ", " + std::to_string(report.differing) +
                   " with different results, from cycle " + std::to_string(report.first_differing) +
                   " on";
    }
    if (report.lost != 0) {
        message += ", " + std::to_string(report.lost) + " missing in the recording";
    }
    message += ".";
    if (!damage.empty()) {
        message += " " + damage;
    }
    if (!poses_only.empty()) {
        message += " " + poses_only;
    }
    const bool identical = report.differing == 0 && report.lost == 0 && report.cycles > 0 &&
                           damage.empty() && poses_only.empty();
    emit_signal("replay_finished", identical, spidar::to_godot(message));
}
