// Recordings that were damaged or made to do harm: bits flipped, files cut, chunks of two files mixed, and fields of any
// value behind checksums that are right. Each is read, printed and played to its end. Nothing may crash, hang or take
// memory without bound; the sanitizers see the rest.
//   stress_recordings --cases N --seed S; case k of a seed replays by --cases 1 --seed S+k.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/touch/touch_scene.h"
#include "device/loop/servo_loop.h"
#include "device/recording/replay.h"
#include "device/simulation/simulated_transport.h"
#include "device/step/servo_step.h"
#include "support/command_line.h"

using namespace spidar;

namespace {

// The largest piece of memory taken since it was set to 0, of this single-threaded program.
std::size_t largest_bytes = 0;
// A chunk's contents and tail, twice: a vector that grows holds the old and the new.
constexpr std::size_t kMostBytes = 2 * (kMostChunkBytes + kChunkTailBytes);

} // namespace

void *operator new(std::size_t size) {
    largest_bytes = std::max(largest_bytes, size);
    if (void *const memory = std::malloc(size > 0 ? size : 1)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Chunk {
    std::uint8_t kind = 0;
    Bytes contents;
};

class Dice {
public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    std::uint64_t bits() { return engine_(); }
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(engine_() % std::max<std::size_t>(count, 1));
    }
    bool one_in(std::size_t count) { return below(count) == 0; }

private:
    std::mt19937_64 engine_;
};

// What the tool stands on: a floor, a box that moves and a mesh; in the second half it holds something.
std::shared_ptr<const TouchScene> scene_of(int frame) {
    static const auto floor = [] {
        ShapeDescription description;
        description.kind = ShapeKind::half_space;
        return cook(description).shape;
    }();
    static const auto box = [] {
        ShapeDescription description;
        description.half_extents_m = Vec3(0.01, 0.005, 0.01);
        return cook(description).shape;
    }();
    static const auto mesh = [] {
        ShapeDescription description;
        description.kind = ShapeKind::mesh;
        description.points_m = {Vec3(-0.03, 0.0, -0.03), Vec3(-0.03, 0.0, 0.03),
                                Vec3(0.03, 0.001, -0.03), Vec3(0.03, 0.0, 0.03)};
        description.indices = {0, 1, 2, 2, 1, 3};
        return cook(description).shape;
    }();
    static const auto hull = [] {
        ShapeDescription description;
        description.kind = ShapeKind::hull;
        description.points_m = {Vec3(0.0), Vec3(0.02, 0.0, 0.0), Vec3(0.0, 0.02, 0.0),
                                Vec3(0.0, 0.0, 0.02), Vec3(0.02, 0.02, 0.015)};
        return make_tool(*cook(description).shape).tool;
    }();
    static const auto ball = make_sphere(0.012).tool;
    auto touch = std::make_shared<TouchScene>();
    touch->shapes = {floor, box, mesh};
    touch->tool_shapes = {ball, hull};
    touch->scene.count = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        touch->scene.parts[i].shape = touch->shapes[i].get();
        touch->scene.parts[i].id = static_cast<std::int32_t>(i);
        touch->scene.parts[i].friction = 0.4;
        touch->scene.parts[i].at.origin_m.y = -0.012;
    }
    touch->scene.parts[1].at.origin_m.x = 0.002 * frame;
    touch->scene.parts[1].velocity_m_s.x = 0.1;
    touch->tool.count = frame < 10 ? 1 : 2;
    for (std::size_t i = 0; i < 2; ++i) {
        touch->tool.parts[i].shape = touch->tool_shapes[i].get();
        touch->tool.parts[i].id = static_cast<std::int32_t>(i);
    }
    return frame % 8 == 7 ? nullptr : touch;
}

// A play with everything in it: shapes, contacts, a coupling, effects, wrenches, faults. One recording begins with the device,
// the other in the middle of a touch.
void record(const std::string &whole, const std::string &middle) {
    PlantSettings plant;
    auto made = std::make_unique<SimulatedTransport>(plant);
    SimulatedTransport &device = *made;
    ServoSettings settings;
    settings.safety.arming_time_s = 0.02;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          made->home_counts(), kPaperMetresPerCount);
    ServoLoop loop(std::move(made));
    (void)loop.start_stepped(settings);
    (void)loop.start_recording(whole);
    HapticCommand command;
    command.forces_enabled = true;
    ServoSnapshot now;
    for (int frame = 0; frame < 20; ++frame) {
        ++command.heartbeat;
        command.contact_count = 1 + frame % 3;
        ++command.contacts_sequence;
        for (int i = 0; i < command.contact_count; ++i) {
            ContactPlane &plane = command.contacts[static_cast<std::size_t>(i)];
            plane.offset_m = 0.005 * i;
            plane.friction = 0.5;
            plane.id = i + 1;
        }
        command.effect_count = frame % 2;
        ++command.effects_sequence;
        if (frame == 10) {
            ++command.wrench_sequence;
            command.wrench.force_n = Vec3(0.0, 0.5, 0.0);
            command.wrench_duration_s = 0.05;
            ++command.coupling_sequence;
            loop.stop_recording();
            (void)loop.start_recording(middle);
        }
        if (frame == 17) {
            device.inject({SimulatedFault::count_jump, 3, 0.0, 0.1});
        }
        loop.publish(command, scene_of(frame));
        HandTarget target;
        target.position_m = Vec3(0.0, frame % 8 < 4 ? -0.02 : 0.01, 0.0);
        device.set_hand_target(target);
        loop.advance(6, 1000);
        (void)loop.latest(now);
        loop.note_read({now.counters.ticks, true, command.contacts_sequence});
    }
    loop.stop();
}

std::string contents_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<Chunk> chunks_of(const std::string &file) {
    std::vector<Chunk> chunks;
    std::size_t at = kRecordingMagic.size();
    while (at + kChunkHeadBytes + kChunkTailBytes <= file.size()) {
        const Bytes head(file.begin() + static_cast<std::ptrdiff_t>(at),
                         file.begin() + static_cast<std::ptrdiff_t>(at + kChunkHeadBytes));
        ByteReader from(head);
        Chunk chunk;
        chunk.kind = static_cast<std::uint8_t>(from.fixed(1));
        (void)from.fixed(4);
        const auto size = static_cast<std::size_t>(from.fixed(4));
        at += kChunkHeadBytes;
        chunk.contents.assign(file.begin() + static_cast<std::ptrdiff_t>(at),
                              file.begin() + static_cast<std::ptrdiff_t>(at + size));
        at += size + kChunkTailBytes;
        chunks.push_back(chunk);
    }
    return chunks;
}

// With numbers and checksums that are right.
std::string file_of(const std::vector<Chunk> &chunks) {
    Bytes bytes(kRecordingMagic.begin(), kRecordingMagic.end());
    std::uint32_t number = 0;
    for (const Chunk &chunk : chunks) {
        Bytes one;
        ByteWriter to(one);
        to.fixed(chunk.kind, 1);
        to.fixed(number, 4);
        to.fixed(chunk.contents.size(), 4);
        to.raw(chunk.contents);
        to.fixed(crc32(one), 4);
        bytes.insert(bytes.end(), one.begin(), one.end());
        ++number;
    }
    return {bytes.begin(), bytes.end()};
}

void spoil_word(Dice &dice, Bytes &bytes) {
    constexpr std::size_t kWord = 8;
    const std::uint64_t values[] = {0,
                                    0x7FF8000000000000U, // NaN
                                    0x7FF0000000000000U, // infinity
                                    0x7FEFFFFFFFFFFFFFU, // the largest number
                                    0x8000000000000000U,
                                    0x7FFFFFFF7FFFFFFFU,
                                    0xFFFFFFFFFFFFFFFFU,
                                    dice.bits()};
    const std::uint64_t value = values[dice.below(std::size(values))];
    const std::size_t at = dice.below(bytes.size() / kWord) * kWord;
    for (std::size_t i = 0; i < kWord && at + i < bytes.size(); ++i) {
        bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
}

void spoil_bytes(Dice &dice, Bytes &bytes) {
    if (bytes.empty() || dice.one_in(20)) {
        bytes.resize(dice.below(64));
    }
    for (std::size_t i = 1 + dice.below(4); i > 0 && !bytes.empty(); --i) {
        if (dice.one_in(3)) {
            spoil_word(dice, bytes);
            continue;
        }
        const std::uint8_t values[] = {
            0, 1, 2, 0x7F, 0x80, 0xFF, static_cast<std::uint8_t>(dice.bits())};
        bytes[dice.below(bytes.size())] = values[dice.below(std::size(values))];
    }
}

// One line of the head with another value.
void spoil_head(Dice &dice, Bytes &bytes) {
    std::string text(bytes.begin(), bytes.end());
    std::vector<std::size_t> values; // where one begins
    for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
        values.push_back(at + 1);
    }
    const char *const others[] = {"nan",
                                  "inf",
                                  "-inf",
                                  "0x1p+1023",
                                  "-0x1p-1074",
                                  "0",
                                  "-1",
                                  "1",
                                  "2",
                                  "255",
                                  "100000",
                                  "2147483647",
                                  "-2147483648",
                                  "9223372036854775807",
                                  "18446744073709551615",
                                  "",
                                  "x",
                                  "0x1p-3",
                                  "0x1.8p+9"};
    for (std::size_t i = 1 + dice.below(2); i > 0 && !values.empty(); --i) {
        const std::size_t at = values[dice.below(values.size())];
        const std::size_t end = std::min(text.find('\n', at), text.size());
        if (at <= end) {
            text.replace(at, end - at, others[dice.below(std::size(others))]);
        }
        values.clear(); // places have moved
    }
    bytes.assign(text.begin(), text.end());
}

void spoil_chunk(Dice &dice, Chunk &chunk) {
    if (chunk.kind == static_cast<std::uint8_t>(ChunkKind::info) && !dice.one_in(10)) {
        spoil_head(dice, chunk.contents);
    } else {
        spoil_bytes(dice, chunk.contents);
    }
}

std::string damaged(Dice &dice, const std::string (&originals)[2]) {
    std::string file = originals[dice.below(2)];
    const std::size_t kind = dice.below(12);
    if (kind == 0) { // what a disk does
        for (std::size_t i = 1 + dice.below(8); i > 0; --i) {
            file[dice.below(file.size())] ^= static_cast<char>(1U << dice.below(8));
        }
        return file;
    }
    if (kind == 1) {
        file.resize(dice.below(file.size()));
        return file;
    }
    std::vector<Chunk> chunks = chunks_of(file);
    if (kind == 2) { // two files mixed
        const std::vector<Chunk> others = chunks_of(originals[dice.below(2)]);
        for (std::size_t i = 1 + dice.below(4); i > 0; --i) {
            const auto place = static_cast<std::ptrdiff_t>(dice.below(chunks.size() + 1));
            chunks.insert(chunks.begin() + place, others[dice.below(others.size())]);
        }
        if (dice.one_in(2)) {
            chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(dice.below(chunks.size())));
        }
        return file_of(chunks);
    }
    if (kind <= 6) { // the memory of the step
        for (Chunk &chunk : chunks) {
            if (chunk.kind == static_cast<std::uint8_t>(ChunkKind::memory)) {
                spoil_bytes(dice, chunk.contents);
            }
        }
        return file_of(chunks);
    }
    if (kind == 7) { // another build's, played as poses
        std::string text(chunks[0].contents.begin(), chunks[0].contents.end());
        text.replace(text.find("build=") + 6, 4, "0000");
        chunks[0].contents.assign(text.begin(), text.end());
    }
    for (std::size_t i = 1 + dice.below(3); i > 0; --i) {
        spoil_chunk(dice, chunks[dice.below(chunks.size())]);
    }
    return file_of(chunks);
}

struct Totals {
    std::uint64_t refused = 0; // not even opened
    std::uint64_t played = 0;
    std::uint64_t poses = 0;
    std::uint64_t unsound = 0; // a memory was refused
    std::uint64_t cycles = 0;
    std::size_t largest_bytes = 0;
};

// Empty: nothing went wrong. No file holds more cycles or reads than it has bytes.
std::string play(const std::string &file, Totals &totals) {
    RecordingReader reader;
    std::string problem = reader.open(std::make_unique<std::istringstream>(file), "damaged");
    RecordedCycle cycle;
    std::size_t read = 0;
    while (problem.empty() && reader.next(cycle)) {
        if (++read > file.size()) {
            return "more cycles than bytes";
        }
        (void)describe(cycle.state);
        (void)describe(cycle.fault);
    }
    auto made = std::make_unique<Replay>();
    Replay &source = *made;
    problem = made->load(file, "damaged");
    if (!problem.empty()) {
        ++totals.refused;
        return {};
    }
    totals.poses += source.why_poses_only().empty() ? 0 : 1;
    const ServoSettings settings = made->settings();
    ServoLoop loop(std::move(made));
    if (!usable(loop.start_stepped(settings))) {
        ++totals.refused;
        return {};
    }
    ServoSnapshot now;
    GameRead game_read;
    for (read = 0; source.next_read(game_read); ++read) {
        if (read > file.size()) {
            return "more reads than bytes";
        }
        loop.advance_to(game_read.tick);
        (void)loop.latest(now);
        if (now.contact_count < 0 || now.contact_count > kMaxContacts) {
            return "a snapshot of " + std::to_string(now.contact_count) + " contacts";
        }
        DeviceEvent event;
        while (loop.next_event(event, now.time_s)) {
            (void)describe(event.kind);
        }
    }
    for (read = 0; !source.report().finished && read <= file.size(); ++read) {
        loop.advance_to(std::numeric_limits<std::uint64_t>::max());
        loop.advance(1, 1000); // a forged number of a cycle may be the largest there is
    }
    if (!source.report().finished || source.report().cycles > file.size()) {
        return "the replay does not end with the file";
    }
    ++totals.played;
    totals.cycles += source.report().cycles;
    totals.unsound += source.damage().find("no servo step can have") != std::string::npos ? 1 : 0;
    return {};
}

} // namespace

int main(int argc, char **argv) {
    const long cases = test::whole_option(argc, argv, "--cases", 10000);
    const long seed = test::whole_option(argc, argv, "--seed", 1);
    if (cases <= 0 || seed < 0) {
        std::fprintf(stderr, "usage: stress_recordings [--cases N>0] [--seed S]\n");
        return 2;
    }
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("spidar_stress_recordings_" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(folder);
    const std::string whole = (folder / "whole.rec").string();
    const std::string middle = (folder / "middle.rec").string();
    record(whole, middle);
    const std::string originals[2] = {contents_of(whole), contents_of(middle)};
    std::filesystem::remove_all(folder);
    long failed = 0;
    Totals totals;
    for (const std::string &original : originals) { // as they are they play to the bit
        Replay check;
        const bool good =
            check.load(original, "original").empty() && check.why_poses_only().empty();
        failed += good && play(original, totals).empty() && totals.unsound == 0 ? 0 : 1;
    }
    for (long i = 0; i < cases; ++i) {
        Dice dice(static_cast<std::uint64_t>(seed + i));
        const std::string file = damaged(dice, originals);
        largest_bytes = 0;
        std::string problem = play(file, totals);
        if (problem.empty() && largest_bytes > kMostBytes) {
            problem = "took " + std::to_string(largest_bytes) + " bytes at once";
        }
        totals.largest_bytes = std::max(totals.largest_bytes, largest_bytes);
        if (!problem.empty()) {
            ++failed;
            std::printf("FAILED: %s; replay: --cases 1 --seed %ld\n", problem.c_str(), seed + i);
        }
    }
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf(
        "%ld damaged recordings: %llu refused when opened, %llu played (%llu as poses, %llu "
        "with a memory refused), %llu cycles; largest memory taken at once: %zu bytes\n",
        cases, number(totals.refused), number(totals.played), number(totals.poses),
        number(totals.unsound), number(totals.cycles), totals.largest_bytes);
    std::printf("%ld passed, %ld failed\n", cases - std::min(failed, cases), failed);
    const bool shown =
        cases < 1000 || (totals.refused > 0 && totals.poses > 0 && totals.unsound > 0);
    return failed == 0 && shown ? 0 : 1;
}
