// Recordings of scenes of real shapes: the shapes and scenes come back to the bit, wherever the recording begins, whatever
// is lost, and whatever stands in the file.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <thread>

#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/touch_words.h"
#include "support/recording_fixture.h"
#include "support/relief_samples.h"
#include "support/stalling_disk.h"
#include "support/touch_scenes.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// A table with boxes, one of which slides; a bumpy mesh; a ball at the grip, and a held bar. A game makes a new scene of
// the same shapes each frame.
class Table {
public:
    explicit Table(int still = 2) : still_(still) {}

    std::shared_ptr<TouchScene> at(int frame) const {
        auto touch = std::make_shared<TouchScene>();
        add_tool(*touch, ball_);
        if (frame % 40 >= 20) {
            add_tool(*touch, bar_, ToolMount::grip, {Vec3(0.0, -0.01, 0.0), Mat3(1.0)}).groups =
                kHeldGroup;
            ToolJoint &hinge = touch->tool.joints[0];
            hinge.id = 7;
            hinge.base.origin_m = Vec3(-0.1, 0.0, 0.0);
            hinge.in_grip.origin_m = Vec3(-0.1, 0.0, 0.0);
            hinge.velocity_m_s = Vec3(0.0, 0.01, 0.0);
            hinge.axes[5] = {-0.4, 0.4, 0.3, 0.1, 0.01, 0.2, 0.05};
            touch->tool.joint_count = 1;
        }
        ScenePart &floor = add(*touch, floor_, {Vec3(0.0, -0.02, 0.0), Mat3(1.0)});
        floor.friction = 0.5;
        floor.belt_m_s = Vec3(0.05, 0.0, -0.02);
        floor.belt_rad_s = Vec3(0.0, 0.3, 0.0);
        floor.traits = {0.8, frame % 2 == 0, 0.4, 0.3, 0.01, {0.004, 0.0002, Vec3(1.0, 0.0, 0.0)}};
        for (int i = 0; i < still_; ++i) {
            add(*touch, box_,
                {Vec3(0.02 * (i % 4) - 0.03, -0.02, 0.03 + 0.02 * (i / 4)), Mat3(1.0)})
                .stiffness_n_m = 800.0;
        }
        for (int i = 0; i < 2; ++i) {
            const double time_s = frame / 60.0;
            ScenePart &slides = add(*touch, box_);
            slides.at.origin_m = Vec3(0.01 * std::sin(5.0 * time_s + i), -0.012, 0.01 * i);
            slides.at.rotation = Mat3(std::cos(time_s), 0.0, -std::sin(time_s), 0.0, 1.0, 0.0,
                                      std::sin(time_s), 0.0, std::cos(time_s));
            slides.velocity_m_s = Vec3(0.05 * std::cos(5.0 * time_s + i), 0.0, 0.0);
            slides.angular_rad_s = Vec3(0.0, 1.0, 0.0);
            slides.friction = 0.3;
        }
        ScenePart &hills = add(*touch, hills_, {Vec3(-0.02, -0.015, 0.0), Mat3(1.0)});
        if (frame % 30 >= 10) {
            hills.traits.texture = {0.02, 0.0003, Vec3(0.0), image_.get()};
            touch->shapes.push_back(image_);
        }
        touch->load.force_n = Vec3(0.0, -0.2, 0.0);
        touch->tool.stop_rad = 0.4;
        return touch;
    }

private:
    int still_;
    ToolResult ball_ = make_sphere(kBall_m);
    ToolResult bar_ = make_tool(*box(Vec3(0.02, 0.004, 0.004)));
    ShapePtr image_ = cooked(relief_noise(16, 16, 1));
    ShapePtr floor_ = cooked_half_space();
    ShapePtr box_ = box(Vec3(0.008, 0.009, 0.01));
    ShapePtr hills_ = cooked(field(
        6, 0.005, [](double x, double z) { return 0.002 * std::sin(900.0 * x + 500.0 * z); }));
};

// What may happen to a scene in a game: nothing to touch, a value that is none, a new tool, a game that is late.
std::shared_ptr<const TouchScene> eventful(const Table &table, int frame) {
    std::shared_ptr<TouchScene> touch = table.at(frame);
    if (frame % 17 == 0) {
        return nullptr;
    }
    if (frame % 13 == 0) { // refused: the last one stands
        touch->scene.parts[1].friction = std::numeric_limits<double>::quiet_NaN();
    }
    if (frame % 19 == 0) {
        touch->scene.parts[0].shape = nullptr;
    }
    if (frame % 23 == 0) {
        touch->scene.count = 99;
    }
    if (frame % 29 == 0) {
        touch->tool.parts[0].mount = static_cast<ToolMount>(7);
    }
    return touch;
}

struct Felt {
    int touching = 0; // cycles in which the hand felt a shape
    std::uint64_t rejected = 0;
};

Felt play(Session &session, int frames) {
    Felt felt;
    for (int i = 0; i < frames; ++i) {
        session.frame();
        const bool touches =
            session.last.touch.point_count > 0 && session.last.touch.wrench.force_n != Vec3(0.0);
        felt.touching += touches ? 1 : 0;
    }
    felt.rejected = session.last.counters.rejected_requests;
    return felt;
}

std::vector<std::uint64_t> part_of(const std::vector<std::uint64_t> &all, std::size_t first,
                                   std::size_t last) {
    return {all.begin() + static_cast<std::ptrdiff_t>(first),
            all.begin() + static_cast<std::ptrdiff_t>(last)};
}

// A step and the memory of pairs that it needs, fed by hand for a recorder at a low rate.
struct TouchBench : Bench {
    std::uint64_t ticks = 0;
    TouchBench() {
        settings.rate_hz = 100.0; // a ring of 400 cycles
        start();
        command.forces_enabled = true;
    }
    void publish(Recorder &recorder, std::shared_ptr<const TouchScene> touch) {
        ++command.touch_sequence;
        command.touch = touch.get();
        recorder.note(NumberedTouch{command.touch_sequence, touch});
        kept.push_back(std::move(touch));
    }
    void cycle(Recorder &recorder, bool command_is_new) {
        constexpr double kStep_s = 0.01;
        reading.counts[0] = static_cast<std::int32_t>(ticks / 7 % 60);
        recorder.begin(step);
        tick(1, kStep_s);
        recorder.end({reading, kStep_s, read_status, Status::ok, true}, drive, now(), command,
                     command_is_new);
        ++ticks;
    }
    std::vector<std::shared_ptr<const TouchScene>> kept;
};

// A recording that begins while the ball rests on the table's shapes; its bytes.
std::string touching_recording(const TemporaryFile &file, int frames, int first_frames = 30) {
    Session session;
    const Table table;
    session.scene = [&table](int frame) { return table.at(frame); };
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    session.frames_of(first_frames);
    REQUIRE(session.last.touch.part_count > 0);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    session.frames_of(frames);
    session.loop->stop();
    return file.contents();
}

} // namespace

TEST_CASE("replay: scenes that move, hold, vanish and are refused, from the first cycle on") {
    const TemporaryFile file;
    Session session;
    const Table table;
    session.scene = [&table](int frame) { return eventful(table, frame); };
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    const Felt felt = play(session, 150);
    session.scene = nullptr; // the game is late
    session.frames_of(30);
    session.loop->stop();
    CHECK(felt.touching > 30);
    CHECK(felt.rejected > 10);

    const Replayed replayed = replay(file.path());
    CHECK(replayed.problem == "");
    CHECK(replayed.damage == "");
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.bits == session.bits);
}

TEST_CASE("replay: two recordings of one run begin in the middle of a touch of shapes") {
    const TemporaryFile first;
    const TemporaryFile second;
    Session session;
    {
        const Table table; // its shapes live on in what the loop keeps
        session.scene = [&table](int frame) { return table.at(frame); };
        REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
        CHECK(play(session, 33).touching > 5);
    }
    session.scene = nullptr;
    const std::size_t first_from = session.bits.size();
    REQUIRE(session.loop->start_recording(first.path()) == "");
    session.frames_of(2);
    const Table other;
    session.scene = [&other](int frame) { return other.at(frame); };
    CHECK(play(session, 25).touching > 5);
    const std::size_t first_to = session.bits.size();
    session.loop->stop_recording();
    session.frames_of(5);
    const std::size_t second_from = session.bits.size();
    REQUIRE(session.loop->start_recording(second.path()) == "");
    CHECK(play(session, 45).touching > 5);
    session.loop->stop();

    const Replayed early = replay(first.path());
    CHECK(early.problem == "");
    CHECK(early.damage == "");
    CHECK(early.report.differing == 0);
    CHECK(early.bits == part_of(session.bits, first_from, first_to));
    const Replayed late = replay(second.path());
    CHECK(late.damage == "");
    CHECK(late.report.differing == 0);
    CHECK(late.bits == part_of(session.bits, second_from, session.bits.size()));
}

TEST_CASE("replay: a threaded loop in real time that touches shapes, recorded twice") {
    const TemporaryFile first;
    const TemporaryFile second;
    Session session;
    const Table table;
    REQUIRE(session.loop->start_threaded(session.settings) == Status::ok);
    bool touched = false;
    for (int i = 0; i < 60; ++i) {
        if (i == 10) {
            REQUIRE(session.loop->start_recording(first.path()) == "");
        }
        if (i == 35) {
            session.loop->stop_recording();
            REQUIRE(session.loop->start_recording(second.path()) == "");
        }
        session.loop->publish(session.command, eventful(table, i));
        HandTarget target;
        target.position_m = Vec3(0.0, -0.01, 0.0);
        session.device->set_hand_target(target);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ServoSnapshot now;
        (void)session.loop->latest(now);
        touched = touched || now.touch.point_count > 0;
    }
    session.loop->stop();
    CHECK(touched);
    for (const TemporaryFile *file : {&first, &second}) {
        const Replayed replayed = replay(file->path());
        CHECK(replayed.problem == "");
        CHECK(replayed.damage == "");
        CHECK(replayed.report.differing == 0);
        CHECK(replayed.report.cycles > 20);
    }
}

TEST_CASE("replay: scenes of cycles that were lost leave their shapes in the file") {
    const TemporaryFile file;
    TouchBench bench;
    REQUIRE(usable(bench.started));
    StallingDisk disk(file.path());
    REQUIRE(disk.is_usable());
    Recorder recorder(bench.settings, true);
    REQUIRE(recorder.open(disk.path()) == "");
    int touching = 0;
    for (int burst = 0; burst < 4; ++burst) {
        const Table table; // other shapes in each burst
        disk.stall();
        const std::uint64_t before = recorder.statistics().lost;
        constexpr int kPatience = 1'000'000;
        for (int i = 0; i < 2500 || (recorder.statistics().lost == before && i < kPatience); ++i) {
            const bool is_new = i % 5 == 0;
            if (is_new) {
                bench.publish(recorder, table.at(i / 5));
            }
            bench.cycle(recorder, is_new);
            touching += bench.now().touch.point_count > 0 ? 1 : 0;
        }
        disk.go_on();
        std::this_thread::sleep_for(std::chrono::milliseconds(100)); // and time to catch up
    }
    recorder.close();
    disk.finish();
    CHECK(touching > 100);
    const RecorderStatistics statistics = recorder.statistics();
    CHECK(statistics.lost > 0);
    CHECK(statistics.cycles + statistics.lost == bench.ticks);
    const Replayed replayed = replay(file.path());
    CHECK(replayed.damage == "");
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.report.cycles == statistics.cycles);
    CHECK(replayed.report.lost == statistics.lost);
}

TEST_CASE("recording: a mesh of more than a chunk comes in pieces") {
    const TemporaryFile file;
    constexpr int kCells = 320;
    const ShapePtr big = cooked(
        field(kCells, 0.0005, [](double x, double z) { return 0.002 * std::sin(90.0 * x + z); }));
    TouchScene touch;
    add_tool(touch, make_sphere(kBall_m));
    add(touch, big);
    RecordingWriter writer;
    REQUIRE(writer.open(file.path(), describe_recording(ideal_settings())) == "");
    writer.shape(*big);
    writer.shape(*touch.tool_shapes.front());
    CycleRecord record;
    record.segment_start = true;
    HapticCommand command;
    command.touch = &touch;
    writer.cycle(record, command);
    writer.close();
    CHECK(std::filesystem::file_size(file.path()) > kMostChunkBytes);

    RecordedShapes shapes;
    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    reader.keep_shapes(&shapes);
    RecordedCycle cycle;
    REQUIRE(reader.next(cycle));
    CHECK(cycle.touch_is_new);
    TouchScene found;
    REQUIRE(load_touch(reader.touch_words(), shapes, found));
    CHECK(usable(validate(found)));
    REQUIRE(found.scene.parts[0].shape != nullptr);
    const ShapeDescription &again = found.scene.parts[0].shape->description();
    CHECK(again.points_m == big->description().points_m);
    CHECK(again.indices == big->description().indices);
    CHECK_FALSE(reader.next(cycle));
    CHECK(reader.closed());
}

TEST_CASE("recording: a scene comes back to the bit, NaN too, and shapes that nobody has as none") {
    std::vector<std::uint64_t> words(count_touch_words());
    std::vector<std::uint64_t> again(words.size());
    const RecordedShapes none;
    CaseRandom random(5, 0);
    const Table table;
    TouchScene found;
    for (int i = 0; i < 200; ++i) {
        const std::shared_ptr<TouchScene> touch = table.at(i);
        for (ScenePart &part : touch->scene.parts) {
            part.at.origin_m = Vec3(random.nasty());
            part.friction = random.nasty();
            part.belt_m_s = Vec3(random.nasty());
            part.belt_rad_s = Vec3(random.nasty());
            part.traits.static_friction = random.nasty();
            part.traits.adhesion_n = random.nasty();
            part.traits.texture = {random.nasty(), random.nasty(), Vec3(random.nasty()),
                                   part.traits.texture.relief};
            part.id = static_cast<std::int32_t>(random.bits());
        }
        for (ToolJoint &joint : touch->tool.joints) {
            joint.base.origin_m = Vec3(random.nasty());
            joint.axes[2].lower = random.nasty();
            joint.axes[5].motor_most = random.nasty();
        }
        touch->tool.joint_count =
            i % 5 == 0 ? static_cast<int>(random.bits()) : i % (kMaxToolJoints + 1);
        touch->tool.stop_rad = random.nasty();
        touch->scene.count = i % 3 == 0 ? static_cast<int>(random.bits()) : i % kMaxSceneParts;
        store_touch(touch.get(), words);
        again = words;
        REQUIRE(load_touch(words, none, found));
        CHECK(found.scene.parts[0].shape == nullptr);
        CHECK(found.tool.parts[0].shape == nullptr);
        CHECK_FALSE(usable(validate(found)));
        // Put the shapes back, and compare all words.
        for (std::size_t k = 0; k < found.scene.parts.size(); ++k) {
            found.scene.parts[k].shape = touch->scene.parts[k].shape;
            found.scene.parts[k].traits.texture.relief =
                touch->scene.parts[k].traits.texture.relief;
        }
        for (std::size_t k = 0; k < found.tool.parts.size(); ++k) {
            found.tool.parts[k].shape = touch->tool.parts[k].shape;
        }
        store_touch(&found, again);
        CHECK(again == words);
    }
    store_touch(nullptr, words);
    CHECK_FALSE(load_touch(words, none, found));
    for (std::uint64_t &word : words) { // what a forged file may hold
        word = random.bits();
    }
    REQUIRE(load_touch(words, none, found));
    CHECK_FALSE(usable(validate(found)));
}

TEST_CASE("recording: any byte of a shape spoiled gives a shape or a refusal") {
    CaseRandom random(6, 0);
    std::vector<std::vector<std::uint8_t>> originals;
    const auto encode = [&originals](const auto &shape) {
        ByteWriter to(originals.emplace_back());
        encode_shape(shape, to);
    };
    const ShapePtr mesh = cooked(box_mesh(Vec3(0.01)));
    const ShapePtr cloud = hull(random_points(random, 12, 0.02));
    encode(*mesh);
    encode(*cloud);
    encode(*cooked(as_height_map(field(2, 0.01, [](double x, double) { return x; }), 2, 0.01)));
    encode(*tool(make_tool(*cloud)));
    encode(*tool(make_pad(0.01, 0.003, 0.001)));
    int made = 0;
    int refused = 0;
    for (const std::vector<std::uint8_t> &bytes : originals) {
        RecordedShapes whole;
        REQUIRE(whole.take(bytes));
        for (std::size_t place = 0; place < bytes.size(); ++place) {
            for (const int value : {0x00, 0x5A, 0x7F, 0xFF}) {
                std::vector<std::uint8_t> spoiled = bytes;
                spoiled[place] = static_cast<std::uint8_t>(value);
                RecordedShapes shapes;
                (shapes.take(spoiled) ? made : refused)++;
            }
            RecordedShapes shapes;
            CHECK_FALSE(shapes.take({bytes.data(), place}));
        }
    }
    CHECK(made > 100);
    CHECK(refused > 100);
}

TEST_CASE("replay: a memory whose shapes are not in the file is refused") {
    const TemporaryFile file;
    (void)touching_recording(file, 3);
    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    const TemporaryFile bare;
    RecordingWriter writer;
    REQUIRE(writer.open(bare.path(), reader.info()) == "");
    copy_cycles(reader, writer, true, nullptr, [](CycleRecord &) {});
    writer.close();
    const Replayed replayed = replay(bare.path());
    CHECK(replayed.bits.empty());
    CHECK(replayed.damage.find("no servo step can have") != std::string::npos);
}

TEST_CASE("replay: shapes and scenes of another build are passed over") {
    const TemporaryFile file;
    const TemporaryFile other;
    (void)touching_recording(file, 10);
    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    RecordingInfo info = reader.info();
    info.build ^= 1U;
    info.touch_words -= 3; // of fewer fields
    const std::shared_ptr<TouchScene> scene = Table().at(0);
    RecordingWriter writer;
    REQUIRE(writer.open(other.path(), info) == "");
    writer.shape(*scene->shapes.front());
    copy_cycles(reader, writer, false, scene.get(), [](CycleRecord &) {});
    writer.close();
    const Replayed replayed = replay(other.path());
    CHECK(replayed.problem == "");
    CHECK(replayed.damage == "");
    CHECK(replayed.report.cycles == reader.cycles());
}

TEST_CASE("replay: a memory with a scene in it, one byte of it spoiled, is refused or as good as "
          "any other") {
    const TemporaryFile file;
    (void)touching_recording(file, 3);
    RecordedShapes shapes;
    RecordingReader reader;
    RecordedCycle cycle;
    REQUIRE(reader.open(file.path()) == "");
    reader.keep_shapes(&shapes);
    REQUIRE(reader.next(cycle));
    const std::vector<std::uint8_t> memory(reader.memory().begin(), reader.memory().end());
    REQUIRE(memory.size() == sizeof(ServoStep));
    HapticCommand command;
    load_words(cycle.command_words, command);
    TouchScene touch;
    REQUIRE(load_touch(reader.touch_words(), shapes, touch));
    const auto pairs = std::make_unique<ProxyMemory>();
    const auto found = std::make_unique<ServoStep>();
    const auto restored = [&](std::size_t place, std::uint8_t value) {
        std::memcpy(static_cast<void *>(found.get()), memory.data(), memory.size());
        reinterpret_cast<unsigned char *>(found.get())[place] = value;
        return found->is_sound() &&
               found->touch().relink(
                   pairs.get(), [&shapes](std::uint64_t number) { return shapes.shape(number); },
                   [&shapes](std::uint64_t number) { return shapes.tool(number); });
    };
    REQUIRE(restored(0, memory[0]));
    REQUIRE_FALSE(found->touch().at_rest());
    // The other parts' bytes are those of a memory without a scene (test_replay.cpp).
    const auto from =
        static_cast<std::size_t>(reinterpret_cast<const std::uint8_t *>(&found->touch()) -
                                 reinterpret_cast<const std::uint8_t *>(found.get()));
    std::size_t refused = 0;
    for (std::size_t i = from; i < from + sizeof(TouchRenderer); ++i) {
        if (!restored(i, i % 2 == 0 ? 0x5A : 0xFF)) {
            ++refused;
            continue;
        }
        command.touch = nullptr; // the scene is the one in the memory
        (void)found->step(Status::ok, cycle.input.reading, command, 0.001, true);
        ++command.touch_sequence;
        command.touch = &touch;
        (void)found->step(Status::ok, cycle.input.reading, command, 0.001, true);
        --command.touch_sequence;
    }
    CHECK(refused > 100); // flags, enumerations, counts and the numbers of shapes
}

TEST_CASE("recording: 60 scenes a second of ten boxes that stand and two that move cost less than "
          "the cycles themselves") {
    double bytes_s[2] = {};
    for (const bool with_scene : {false, true}) {
        const TemporaryFile file;
        Session session;
        const Table table(10);
        REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
        if (with_scene) {
            session.scene = [&table](int frame) { return table.at(frame); };
        }
        session.frames_of(5);
        REQUIRE(session.loop->start_recording(file.path()) == "");
        session.frames_of(100);
        const auto before = static_cast<double>(session.loop->recording_statistics().bytes);
        const double from_s = session.last.time_s;
        session.frames_of(600);
        const double seconds = session.last.time_s - from_s;
        bytes_s[with_scene ? 1 : 0] =
            (static_cast<double>(session.loop->recording_statistics().bytes) - before) / seconds;
        session.loop->stop();
    }
    MESSAGE("bytes a second without a scene: " << bytes_s[0] << ", with one: " << bytes_s[1]);
    CHECK(bytes_s[1] - bytes_s[0] < 12'000.0);
}
