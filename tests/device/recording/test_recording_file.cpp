// The file itself: what it tells, and what is left of it when it is cut or damaged anywhere.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/reading_fields.h"
#include "device/recording/codec/touch_words.h"
#include "support/recording_fixture.h"
#include "support/touch_scenes.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// A recording of `cycles` cycles that hold all kinds of values, in chunks of a few, with a scene of shapes.
std::string small_recording(int cycles, const TemporaryFile &file) {
    RecordingWriter writer;
    RecordingInfo info = describe_recording(ideal_settings());
    REQUIRE(writer.open(file.path(), info) == "");
    const std::vector<std::uint8_t> memory = {1, 2, 3, 4, 5};
    std::mt19937_64 random(11);
    HapticCommand command;
    TouchScene touch;
    add_tool(touch, make_sphere(kBall_m));
    add(touch, cooked(box_mesh(Vec3(0.01))));
    writer.shape(*touch.shapes.front());
    writer.shape(*touch.tool_shapes.front());
    for (int i = 0; i < cycles; ++i) {
        command.touch = i % 15 == 0 ? nullptr : &touch;
        command.touch_sequence += i % 5 == 0 ? 1U : 0U;
        touch.scene.parts[0].at.origin_m.x = i;
        CycleRecord record;
        record.segment_start = i % 20 == 0;
        record.command_is_new = i % 5 == 0;
        record.tick = static_cast<std::uint64_t>(i) + 1;
        record.input.reading.counts[static_cast<std::size_t>(i % 8)] = i * 100 - 2000;
        record.input.reading.device_time_us = static_cast<std::uint64_t>(i) * 1000;
        record.input.reading.sequence = static_cast<std::uint16_t>(i);
        record.input.dt_s = i % 3 == 0 ? 0.001 : 0.00103;
        record.output.values[kOutputTensions] = 0.1 * i;
        command.wrench.force_n.x = i;
        if (record.segment_start) {
            if (i != 0) {
                writer.gap(3);
            }
            writer.memory(memory);
        }
        writer.cycle(record, command);
        writer.read({record.tick, i % 3 == 0, static_cast<std::uint64_t>(i / 2)});
        if (random() % 4 == 0) {
            writer.flush();
        }
    }
    writer.close();
    CHECK(writer.good());
    return file.contents();
}

struct Contents {
    std::string problem;
    std::string damage;
    bool closed = false;
    std::vector<std::uint32_t> digests;
    std::vector<CountArray> counts;
    std::vector<double>
        scenes; // where the mesh is; -1 without a scene, -2 with one that is not valid
    std::vector<std::uint64_t> reads; // the ticks
};

Contents read(const std::string &bytes) {
    Contents contents;
    RecordingReader reader;
    contents.problem = reader.open(std::make_unique<std::istringstream>(bytes), "test");
    RecordedCycle cycle;
    RecordedShapes shapes;
    TouchScene touch;
    reader.keep_shapes(&shapes);
    while (contents.problem.empty() && reader.next(cycle)) {
        const bool is_there = load_touch(reader.touch_words(), shapes, touch);
        contents.scenes.push_back(!is_there                  ? -1.0
                                  : !usable(validate(touch)) ? -2.0
                                                             : touch.scene.parts[0].at.origin_m.x);
        contents.digests.push_back(cycle.digest);
        contents.counts.push_back(cycle.input.reading.counts);
    }
    contents.damage = reader.damage();
    contents.closed = reader.closed();
    RecordingReader second;
    GameRead read;
    contents.problem = second.open(std::make_unique<std::istringstream>(bytes), "test");
    while (contents.problem.empty() && second.next(read)) {
        CHECK(read.physics_tick == ((read.tick - 1) % 3 == 0));
        CHECK(read.contacts_sequence == (read.tick - 1) / 2);
        contents.reads.push_back(read.tick);
    }
    return contents;
}

template <typename T>
bool begins_with(const std::vector<T> &whole, const std::vector<T> &part) {
    return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

} // namespace

TEST_CASE("recording: cut at every byte, it opens up to there and says where") {
    const TemporaryFile file;
    const std::string whole = small_recording(60, file);
    const Contents all = read(whole);
    REQUIRE(all.problem == "");
    REQUIRE(all.damage == "");
    REQUIRE(all.closed);
    REQUIRE(all.digests.size() == 60);
    REQUIRE(all.reads.size() == 60);
    for (int i = 0; i < 60; ++i) {
        CHECK(all.scenes[static_cast<std::size_t>(i)] == (i / 5 % 3 == 0 ? -1.0 : i / 5 * 5.0));
    }
    std::size_t most = 0;
    bool once_opened = false;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Contents cut = read(whole.substr(0, size));
        const bool told = !cut.problem.empty() || !cut.damage.empty();
        const bool right = begins_with(all.digests, cut.digests) &&
                           begins_with(all.counts, cut.counts) &&
                           begins_with(all.scenes, cut.scenes) &&
                           begins_with(all.reads, cut.reads) && !cut.closed && told &&
                           cut.digests.size() >= most && (cut.problem.empty() || !once_opened);
        if (!right) {
            CAPTURE(size);
            REQUIRE(right);
        }
        most = cut.digests.size();
        once_opened = once_opened || cut.problem.empty();
    }
    CHECK(once_opened);
    CHECK(most == 60); // only the end mark was missing in the longest
}

TEST_CASE("recording: a flipped bit in any byte is noticed, and what came before it is whole") {
    const TemporaryFile file;
    const std::string whole = small_recording(60, file);
    const Contents all = read(whole);
    std::mt19937_64 random(5);
    for (std::size_t place = 0; place < whole.size(); ++place) {
        std::string damaged = whole;
        damaged[place] = static_cast<char>(damaged[place] ^ (1U << (random() % 8)));
        const Contents left = read(damaged);
        const bool told = !left.problem.empty() || !left.damage.empty();
        const bool right = told && !left.closed && begins_with(all.digests, left.digests) &&
                           begins_with(all.counts, left.counts) &&
                           begins_with(all.scenes, left.scenes);
        if (!right) {
            CAPTURE(place);
            CAPTURE(left.damage);
            REQUIRE(right);
        }
    }
}

TEST_CASE("recording: bytes after the end, random bytes and other files are told apart") {
    const TemporaryFile file;
    const std::string whole = small_recording(20, file);
    const Contents longer = read(whole + "more");
    CHECK_FALSE(longer.closed);
    CHECK(longer.damage.find("after its end") != std::string::npos);
    CHECK(longer.digests.size() == 20);
    CHECK(read("").problem.find("not a recording") != std::string::npos);
    CHECK(read("RIFF....WAVE").problem.find("not a recording") != std::string::npos);
    std::mt19937_64 random(9);
    for (int i = 0; i < 300; ++i) {
        std::string noise = whole.substr(0, 8);
        for (int byte = 0; byte < 200; ++byte) {
            noise.push_back(static_cast<char>(random()));
        }
        CHECK_FALSE(read(noise).problem.empty());
    }
}

TEST_CASE("recording: every input comes back to the bit, NaN and wrap-around too") {
    const TemporaryFile file;
    std::mt19937_64 random(21);
    std::vector<CycleRecord> records(500);
    std::vector<HapticCommand> commands(records.size());
    RecordingWriter writer;
    REQUIRE(writer.open(file.path(), describe_recording(ideal_settings())) == "");
    for (std::size_t i = 0; i < records.size(); ++i) {
        CycleRecord &record = records[i];
        record = i == 0 ? CycleRecord() : records[i - 1];
        commands[i] = i == 0 ? HapticCommand() : commands[i - 1];
        record.segment_start = i == 0 || random() % 100 == 0;
        record.tick = i + 1;
        for (std::int32_t &count : record.input.reading.counts) {
            count = random() % 3 == 0 ? static_cast<std::int32_t>(random()) : count;
        }
        record.input.reading.sequence = static_cast<std::uint16_t>(random() >> (random() % 64));
        record.input.reading.device_time_us += random() % 4 == 0 ? random() : 1000;
        record.input.reading.buttons = static_cast<std::uint8_t>(random() % 4);
        record.input.dt_s = random() % 3 == 0   ? std::bit_cast<double>(random())
                            : random() % 2 == 0 ? 0.001
                                                : static_cast<double>(random() % 3000000) * 1e-9;
        record.input.read_status = random() % 5 == 0 ? Status::read_timeout : Status::ok;
        record.input.write_status = random() % 7 == 0 ? Status::write_failed : Status::ok;
        record.input.may_arm_itself = random() % 2 == 0;
        record.command_is_new = random() % 3 == 0;
        if (record.command_is_new || record.segment_start) {
            for_each_field(commands[i], [&](std::string_view, int, auto &field) {
                if (random() % 4 == 0) {
                    from_word(random(), field);
                }
            });
        }
        record.output.state = static_cast<DeviceState>(random() % 6);
        record.output.grasp = static_cast<GraspPhase>(random() % 3);
        record.output.motors_on = random() % 2 == 0;
        record.output.fault_string = static_cast<std::int8_t>(random() % 9 - 1);
        record.output.fault = random() % 2 == 0 ? Status::count_jump : Status::ok;
        for (double &value : record.output.values) {
            value = random() % 9 == 0 ? std::nan("") : 1e-3 * static_cast<double>(random() % 9000);
        }
        writer.cycle(record, commands[i]);
    }
    writer.close();
    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    RecordedCycle cycle;
    std::vector<std::uint64_t> words(count_fields(HapticCommand{}));
    for (std::size_t i = 0; i < records.size(); ++i) {
        CAPTURE(i);
        REQUIRE(reader.next(cycle));
        const CycleRecord &record = records[i];
        store_words(commands[i], words);
        CHECK(cycle.command_words == words);
        CHECK(cycle.input.reading.counts == record.input.reading.counts);
        CHECK(cycle.input.reading.sequence == record.input.reading.sequence);
        CHECK(cycle.input.reading.device_time_us == record.input.reading.device_time_us);
        CHECK(cycle.input.reading.buttons == record.input.reading.buttons);
        CHECK(to_word(cycle.input.dt_s) == to_word(record.input.dt_s));
        CHECK(cycle.input.read_status == record.input.read_status);
        CHECK(cycle.input.write_status == record.input.write_status);
        CHECK(cycle.input.may_arm_itself == record.input.may_arm_itself);
        CHECK(cycle.tick == record.tick);
        CHECK(cycle.segment_start == record.segment_start);
        CHECK(cycle.state == record.output.state);
        CHECK(cycle.grasp == record.output.grasp);
        CHECK(cycle.motors_on == record.output.motors_on);
        CHECK(cycle.fault == record.output.fault);
        CHECK(cycle.fault_string == record.output.fault_string);
        CHECK(cycle.tensions_mn == millinewtons_of(record.output));
        CHECK(cycle.digest == digest_of(record.output));
    }
    CHECK_FALSE(reader.next(cycle));
    CHECK(reader.closed());
}

TEST_CASE(
    "recording: readings of a version with more fields are read, the unknown ones passed over") {
    CycleRecord record;
    record.segment_start = true;
    record.tick = 1;
    record.input.reading.device_time_us = 7;
    std::vector<std::uint8_t> bytes;
    ByteWriter to(bytes);
    CycleEncoder encoder;
    encoder.encode(record, HapticCommand(), to);
    // Flags 2 bytes, tick 1, the clock's word 2, then a byte for each word that is as expected.
    const std::size_t own = count_fields(DeviceReading{});
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(2 + 1 + 2 + own - 1 + 1);
    const std::vector<std::uint8_t> unknown = {0x01, 0x05};
    bytes.insert(place, unknown.begin(), unknown.end());
    const std::size_t end_of_first = bytes.size();
    record.segment_start = false;
    record.input.reading.device_time_us = 14;
    record.input.reading.sequence = 1;
    encoder.encode(record, HapticCommand(), to); // as expected: nothing of the reading is told
    CHECK(bytes.size() > end_of_first);

    CycleDecoder decoder(count_fields(HapticCommand{}), own + 1, count_touch_words());
    ByteReader from(bytes);
    RecordedCycle cycle;
    REQUIRE(decoder.decode(from, cycle));
    CHECK(cycle.input.reading.device_time_us == 7);
    CHECK(cycle.input.reading.sequence == 0);
    REQUIRE(decoder.decode(from, cycle));
    CHECK(cycle.input.reading.device_time_us == 14);
    CHECK(cycle.input.reading.sequence == 1);
    CHECK(cycle.tick == 2);
    CHECK(cycle.digest == digest_of(record.output));
    CHECK(from.empty());
}

TEST_CASE("recording: the head gives the settings back, to the bit, in any locale's text") {
    ServoSettings settings = ideal_settings();
    settings.rate_hz = 1234.5678;
    settings.safety.max_force_n = 0.1;
    settings.frame.motors_m[3].y = -1.0 / 3.0;
    settings.grip.attachments[2].pole = 1;
    settings.tension.dof_mask = 0x15;
    settings.strings.zero_count[5] = -70000;
    RecordingInfo info = describe_recording(settings);
    const std::string text = to_text(info);
    RecordingInfo back;
    REQUIRE(read_text(text, back) == "");
    CHECK(to_text(back) == text);
    CHECK(back.settings.rate_hz == settings.rate_hz);
    CHECK(back.settings.frame.motors_m[3].y == settings.frame.motors_m[3].y);
    CHECK(back.settings.tension.dof_mask == 0x15);
    CHECK(back.settings.strings.zero_count[5] == -70000);
    CHECK(back.build == info.build);
    CHECK(back.settings.tension.simd == info.settings.tension.simd);
    // Fields of a later version are passed over; what cannot be is refused.
    CHECK(read_text(text + "settings.safety.invented.0=0x1p+0\n", back) == "");
    CHECK(read_text(text + "command_words=-3\n", back).find("is not valid") != std::string::npos);
    CHECK(read_text("spidar_g recording\nformat=1\n", back) == "");
    CHECK(read_text("spidar_g recording\nformat=4\n", back).find("format 4") != std::string::npos);
    CHECK(read_text("spidar_g recording\nformat=0\n", back).find("format 0") != std::string::npos);
    CHECK(read_text("spidar_g recording\n", back).find("no format") != std::string::npos);
}

TEST_CASE("recording: at most 64 bytes a cycle, moving, with a contact that changes each frame") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    session.frames_of(600);
    session.loop->stop();
    const auto bytes = static_cast<double>(std::filesystem::file_size(file.path()));
    const double bytes_a_cycle = bytes / static_cast<double>(session.bits.size());
    MESSAGE("bytes a cycle, head and memory included: " << bytes_a_cycle);
    CHECK(bytes_a_cycle <= 64.0);
}
