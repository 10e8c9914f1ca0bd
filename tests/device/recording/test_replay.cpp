// A recorded run and its replay: the same bits, wherever the recording began and whatever happened in it.
#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <new>
#include <thread>

#include <glm/geometric.hpp>

#include "device/recording/codec/command_fields.h"
#include "support/allocation_trap.h"
#include "support/recording_fixture.h"
#include "support/stalling_disk.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// What is left of `all` after its first `skipped`.
std::vector<std::uint64_t> from(const std::vector<std::uint64_t> &all, std::size_t skipped) {
    return {all.begin() + static_cast<std::ptrdiff_t>(skipped), all.end()};
}

// Cycles after which a ring that is not read is full on any machine.
constexpr int kPatience = 1'000'000;

} // namespace

TEST_CASE(
    "replay: a run from its first cycle, with contacts, wrenches, a lost device and a fault") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    CHECK(session.loop->recording());
    session.frames_of(60);
    CHECK(session.last.state == DeviceState::active);
    CHECK(session.last.counters.gate_clamps == 0);
    session.unplug_for(0.05);
    session.frames_of(10);
    CHECK(session.last.state == DeviceState::closed);
    session.clear_and_arm();
    session.frames_of(20);
    session.device->inject({SimulatedFault::count_jump, 3, 0.0, 0.1});
    session.frames_of(10);
    CHECK(session.last.state == DeviceState::fault);
    session.device->inject({SimulatedFault::read_timeout, 0, 0.0, 0.03});
    session.clear_and_arm();
    session.frames_of(20);
    session.loop->stop_recording();
    CHECK_FALSE(session.loop->recording());
    const RecorderStatistics statistics = session.loop->recording_statistics();
    CHECK(statistics.cycles == session.bits.size());
    CHECK(statistics.lost == 0);
    CHECK_FALSE(statistics.failed);
    CHECK(statistics.bytes == std::filesystem::file_size(file.path()));

    const Replayed replayed = replay(file.path());
    CHECK(replayed.problem == "");
    CHECK(replayed.damage == "");
    CHECK(replayed.bits == session.bits);
    CHECK(replayed.report.cycles == session.bits.size());
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.report.lost == 0);
}

TEST_CASE("replay: a recording that starts in the middle of a touch, twice in one run") {
    const TemporaryFile first;
    const TemporaryFile second;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    session.frames_of(37);
    const std::size_t first_from = session.bits.size();
    REQUIRE(session.loop->start_recording(first.path()) == "");
    session.frames_of(20);
    const std::size_t first_to = session.bits.size();
    // The same path or another: a second recording beside the first is refused.
    CHECK(session.loop->start_recording(second.path()).find("already running") !=
          std::string::npos);
    session.loop->stop_recording();
    session.frames_of(5);
    const std::size_t second_from = session.bits.size();
    REQUIRE(session.loop->start_recording(second.path()) == "");
    session.frames_of(30);
    session.loop->stop(); // ends the recording too

    const Replayed early = replay(first.path());
    CHECK(early.problem == "");
    std::vector<std::uint64_t> expected = from(session.bits, first_from);
    expected.resize(first_to - first_from);
    CHECK(early.bits == expected);
    CHECK(early.report.differing == 0);
    const Replayed late = replay(second.path());
    CHECK(late.bits == from(session.bits, second_from));
    CHECK(late.report.differing == 0);
    CHECK(late.damage == "");
}

TEST_CASE("replay: the game is handed what it read then, read for read, in both drive modes") {
    for (const bool threaded : {false, true}) {
        const TemporaryFile file;
        Session session;
        const Status started = threaded ? session.loop->start_threaded(session.settings)
                                        : session.loop->start_stepped(session.settings);
        REQUIRE(started == Status::ok);
        REQUIRE(session.loop->start_recording(file.path()) == "");
        struct Seen {
            GameRead read;
            std::uint64_t bits;
        };
        std::vector<Seen> seen;
        ServoSnapshot now;
        for (int i = 0; i < 60; ++i) {
            ++session.command.contacts_sequence;
            session.command.contact_count = i % 3;
            session.loop->publish(session.command);
            if (threaded) {
                std::this_thread::sleep_for(std::chrono::milliseconds(i % 7));
            } else {
                session.loop->advance(static_cast<std::uint32_t>(i % 7), 1000);
            }
            const bool is_newer = session.loop->latest(now);
            const bool physics_tick = i % 4 != 0; // also one that finds no newer cycle
            if ((is_newer || physics_tick) && now.counters.ticks > 0) {
                seen.push_back(
                    {{now.counters.ticks, physics_tick, session.command.contacts_sequence},
                     bits_of(now)});
                session.loop->note_read(seen.back().read);
            }
        }
        session.loop->stop();

        auto made = std::make_unique<Replay>();
        Replay &source = *made;
        REQUIRE(made->load(file.path()) == "");
        const ServoSettings settings = made->settings();
        ServoLoop loop(std::move(made));
        REQUIRE(loop.start_stepped(settings) == Status::ok);
        RecordingReader reader;
        RecordedCycle cycle;
        REQUIRE(reader.open(file.path()) == "");
        REQUIRE(reader.next(cycle));
        const std::uint64_t first = cycle.tick;
        for (const Seen &expected : seen) {
            GameRead read;
            REQUIRE(source.next_read(read));
            CHECK(read == expected.read);
            loop.advance_to(read.tick);
            (void)loop.latest(now);
            // A read that came before the first recorded cycle is handed what that cycle began with.
            CHECK(now.counters.ticks == std::max(read.tick, first - 1));
            CHECK((read.tick < first - 1 || bits_of(now) == expected.bits));
            CHECK(source.contacts_sequence() <= read.contacts_sequence);
        }
        CHECK(seen.back().read.tick > first);
        GameRead read;
        CHECK_FALSE(source.next_read(read));
        loop.advance_to(std::numeric_limits<std::uint64_t>::max()); // ends with the recording
        CHECK(source.report().finished);
        CHECK(source.report().differing == 0);
    }
}

TEST_CASE("loop: an event that is newer than what the game has read waits for it") {
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    session.loop->advance(1, 10);
    ServoSnapshot now;
    REQUIRE(session.loop->latest(now));
    DeviceEvent event;
    while (session.loop->next_event(event, now.time_s)) {
        CHECK(event.time_s <= now.time_s);
    }
    session.device->inject({SimulatedFault::count_jump, 3, 0.0, 0.1});
    session.loop->advance(1, 10);
    CHECK_FALSE(session.loop->next_event(event, now.time_s)); // of cycles that nobody has read yet
    REQUIRE(session.loop->latest(now));
    CHECK(session.loop->next_event(event, now.time_s));
}

TEST_CASE(
    "replay: other inputs give other outputs, and that is noticed at the cycle where it happens") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    session.frames_of(30);
    session.loop->stop();
    // The same recording with one count of one cycle moved by one.
    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    const TemporaryFile changed;
    RecordingWriter writer;
    REQUIRE(writer.open(changed.path(), reader.info()) == "");
    constexpr std::uint64_t kChangedTick = 200;
    copy_cycles(reader, writer, true, nullptr, [](CycleRecord &record) {
        record.input.reading.counts[2] += record.tick == kChangedTick ? 1 : 0;
    });
    writer.close();
    // Its outputs are not the recorded ones (all zero), so the transport's own count says nothing here: the bits do.
    const Replayed before = replay(file.path());
    const Replayed after = replay(changed.path());
    REQUIRE(before.bits.size() == after.bits.size());
    CHECK(after.report.differing == after.bits.size());
    CHECK(after.report.first_differing == 1);
    std::size_t same = 0;
    while (same < before.bits.size() && before.bits[same] == after.bits[same]) {
        ++same;
    }
    CHECK(same == kChangedTick - 1);
    CHECK(before.report.differing == 0);
}

TEST_CASE("replay: a threaded loop in real time, recorded beside its own thread") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_threaded(session.settings) == Status::ok);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    REQUIRE(session.loop->start_recording(file.path()) == "");
    for (int i = 0; i < 20; ++i) {
        ++session.command.contacts_sequence;
        session.command.contact_count = i % 3;
        session.loop->publish(session.command);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    session.loop->stop_recording();
    const RecorderStatistics statistics = session.loop->recording_statistics();
    CHECK(statistics.cycles > 20);
    session.loop->stop();
    const Replayed replayed = replay(file.path());
    CHECK(replayed.problem == "");
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.report.cycles + replayed.report.lost >= statistics.cycles);
    CHECK(replayed.damage == "");
}

TEST_CASE("replay: a ring that overflows loses cycles, says so, and goes on with exact segments") {
    const TemporaryFile file;
    Bench bench;
    bench.settings.rate_hz = 100.0; // a ring of 400 cycles
    bench.start();
    REQUIRE(usable(bench.started));
    bench.command.forces_enabled = true;
    StallingDisk disk(file.path());
    REQUIRE(disk.is_usable());
    Recorder recorder(bench.settings, true);
    REQUIRE(recorder.open(disk.path()) == "");
    constexpr double kStep_s = 0.01;
    std::uint64_t ticks = 0;
    for (int burst = 0; burst < 3; ++burst) {
        disk.stall();
        const std::uint64_t before = recorder.statistics().lost;
        for (int i = 0; i < 3000 || (recorder.statistics().lost == before && i < kPatience); ++i) {
            bench.reading.counts[0] = (i / 7) % 20;
            recorder.begin(bench.step);
            bench.tick(1, kStep_s);
            recorder.end({bench.reading, kStep_s, bench.read_status, Status::ok, true}, bench.drive,
                         bench.now(), bench.command, false);
            ++ticks;
        }
        disk.go_on();
        // Time to catch up: until nothing more comes to the file.
        constexpr auto kLook = std::chrono::milliseconds(100);
        std::uint64_t bytes = 0;
        do {
            bytes = recorder.statistics().bytes;
            std::this_thread::sleep_for(kLook);
        } while (recorder.statistics().bytes != bytes);
    }
    recorder.close();
    disk.finish();
    const RecorderStatistics statistics = recorder.statistics();
    CHECK(statistics.lost > 0);
    CHECK(statistics.cycles + statistics.lost == ticks);

    RecordingReader reader;
    REQUIRE(reader.open(file.path()) == "");
    RecordedCycle cycle;
    int segments = 0;
    while (reader.next(cycle)) {
        segments += cycle.segment_start ? 1 : 0;
    }
    CHECK(segments >= 2); // one a burst, unless a busy machine left the ring full
    CHECK(reader.closed());
    CHECK(reader.cycles() == statistics.cycles);
    CHECK(reader.lost() == statistics.lost);
    const Replayed replayed = replay(file.path());
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.report.cycles == statistics.cycles);
    CHECK(replayed.report.lost == statistics.lost);
}

TEST_CASE("recording: the servo thread's part allocates nothing, not at the start and not when it "
          "loses") {
    const TemporaryFile file;
    Bench bench;
    bench.settings.rate_hz = 200.0;
    bench.settings.safety.arming_time_s = 0.02;
    bench.start();
    bench.command.forces_enabled = true;
    StallingDisk disk(file.path());
    REQUIRE(disk.is_usable());
    Recorder recorder(bench.settings, true);
    REQUIRE(recorder.open(disk.path()) == "");
    disk.stall();
    const std::size_t before = allocations_of_this_thread();
    for (int i = 0; i < 5000 || (recorder.statistics().lost == 0 && i < kPatience); ++i) {
        const bool command_is_new = i % 16 == 0;
        bench.command.contacts_sequence += command_is_new ? 1 : 0;
        bench.command.contact_count = 1 + i % 4;
        bench.reading.counts[static_cast<std::size_t>(i % 8)] += i % 3 - 1;
        recorder.begin(bench.step);
        bench.tick(1, 0.005);
        recorder.end({bench.reading, 0.005, bench.read_status, Status::ok, true}, bench.drive,
                     bench.now(), bench.command, command_is_new);
    }
    const std::size_t made = allocations_of_this_thread() - before;
    CHECK(made == 0);
    disk.go_on();
    recorder.close();
    const RecorderStatistics statistics = recorder.statistics();
    CHECK(statistics.cycles > 0);
    CHECK(statistics.lost > 0); // both ways were gone
    ::operator delete (::operator new (1, std::align_val_t{64}), std::align_val_t{64});
    CHECK(allocations_of_this_thread() > before); // the trap itself works
}

TEST_CASE("replay: each recording runs at its own vector level, beside a loop at another") {
    const TemporaryFile file;
    Session session;
    session.settings.tension.simd = SimdLevel::plain;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    session.frames_of(30);
    session.loop->stop();

    const TemporaryFile of_best;
    Session best;
    best.settings.tension.simd = best_simd_level();
    REQUIRE(best.loop->start_stepped(best.settings) == Status::ok);
    REQUIRE(best.loop->start_recording(of_best.path()) == "");
    best.frames_of(15);
    const Replayed replayed = replay(file.path()); // in the middle of the other's run
    CHECK(replayed.report.differing == 0);
    CHECK(replayed.bits == session.bits);
    best.frames_of(15);
    best.loop->stop();
    const Replayed at_best = replay(of_best.path());
    CHECK(at_best.report.differing == 0);
    CHECK(at_best.bits == best.bits);
    CHECK((best_simd_level() == SimdLevel::plain || best.bits != session.bits));
}

TEST_CASE("replay: a recording of another build plays as poses, tick for tick, and says so") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    session.frames_of(20);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    std::vector<ServoSnapshot> seen;
    for (int i = 0; i < 30; ++i) {
        session.frame();
        seen.push_back(session.last);
        session.loop->note_read({session.last.counters.ticks, true, 0});
    }
    session.loop->stop();
    REQUIRE(seen.back().state == DeviceState::active);

    RecordingReader reader;
    RecordingReader reads;
    REQUIRE(reader.open(file.path()) == "");
    REQUIRE(reads.open(file.path()) == "");
    const TemporaryFile other;
    RecordingInfo info = reader.info();
    info.build ^= 1U;
    info.settings.tension.simd = static_cast<SimdLevel>(2); // AVX-512, of versions before this one
    RecordingWriter writer;
    REQUIRE(writer.open(other.path(), info) == "");
    RecordedCycle cycle;
    HapticCommand command;
    while (reader.next(cycle)) {
        if (cycle.segment_start) {
            writer.memory({}); // a memory of another build: this one looks at none
        }
        load_words(cycle.command_words, command);
        CycleRecord record;
        record.input = cycle.input;
        static_cast<CycleState &>(record.output) = cycle;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            record.output.values[kOutputTensions + i] = 1e-3 * cycle.tensions_mn[i];
        }
        record.tick = cycle.tick;
        record.segment_start = cycle.segment_start;
        record.command_is_new = cycle.command_is_new;
        writer.cycle(record, command);
    }
    GameRead read;
    while (reads.next(read)) {
        writer.read(read);
    }
    writer.close();

    auto made = std::make_unique<Replay>();
    Replay &source = *made;
    REQUIRE(made->load(other.path()) == "");
    CHECK(source.why_poses_only().find("another build") != std::string::npos);
    CHECK(source.why_poses_only().find("replays the poses only") != std::string::npos);
    const ServoSettings settings = made->settings();
    ServoLoop loop(std::move(made));
    REQUIRE(loop.start_stepped(settings) == Status::ok);
    ServoSnapshot now;
    for (const ServoSnapshot &then : seen) {
        REQUIRE(source.next_read(read));
        loop.advance_to(read.tick);
        REQUIRE(loop.latest(now));
        CHECK(now.counters.ticks == then.counters.ticks);
        CHECK(now.state == then.state);
        CHECK(now.grasp == then.grasp);
        CHECK(now.grip.status == then.grip.status);
        const double apart_m = glm::distance(now.grip.pose.position_m, then.grip.pose.position_m);
        const double turned_rad =
            std::abs(now.grip.frame.grasp_angle_rad - then.grip.frame.grasp_angle_rad);
        // Kinematics that began later settle within less than a count, which is 25 um.
        CHECK(apart_m < 2e-5);
        CHECK(turned_rad < 1e-3);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            CHECK(std::abs(now.tensions_n[i] - then.tensions_n[i]) < 1e-3);
        }
    }
    loop.advance_to(std::numeric_limits<std::uint64_t>::max());
    CHECK(source.report().finished);
    CHECK(source.report().differing == 0); // nothing was compared
    CHECK(source.damage() == "");
}

TEST_CASE(
    "replay: a memory with a flag or an index that cannot be is refused, whatever its checksum") {
    const TemporaryFile file;
    Session session;
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    session.frames_of(10);
    REQUIRE(session.loop->start_recording(file.path()) == "");
    session.frames_of(3);
    session.loop->stop();
    RecordingReader reader;
    RecordedCycle cycle;
    REQUIRE(reader.open(file.path()) == "");
    REQUIRE(reader.next(cycle));
    const std::vector<std::uint8_t> memory(reader.memory().begin(), reader.memory().end());
    REQUIRE(memory.size() == sizeof(ServoStep));

    HapticCommand command;
    load_words(cycle.command_words, command);
    const auto found = std::make_unique<ServoStep>();
    std::size_t refused = 0;
    // One byte of it at a time: refused, or as good as any other. A sanitizer sees the flag that nobody checked.
    for (std::size_t i = 0; i < memory.size(); ++i) {
        for (const unsigned char value : {std::uint8_t{0x5A}, std::uint8_t{0xFF}}) {
            std::memcpy(static_cast<void *>(found.get()), memory.data(), memory.size());
            reinterpret_cast<unsigned char *>(found.get())[i] = value;
            const bool taken =
                found->is_sound() &&
                found->touch().relink( // as a replay does
                    nullptr, [](std::uint64_t) -> const CookedShape * { return nullptr; },
                    [](std::uint64_t) -> const ToolShape * { return nullptr; });
            if (!taken) {
                ++refused;
                continue;
            }
            for (int step = 0; step < 2; ++step) {
                (void)found->step(Status::ok, cycle.input.reading, command, 0.001, true);
            }
        }
    }
    CHECK(refused > 200); // flags, enumerations and counts
    std::memcpy(static_cast<void *>(found.get()), memory.data(), memory.size());
    CHECK(found->is_sound());

    std::vector<std::uint8_t> forged = memory;
    std::fill(forged.begin(), forged.end(), 0x5A);
    const TemporaryFile bad;
    RecordingWriter writer;
    REQUIRE(writer.open(bad.path(), reader.info()) == "");
    writer.memory(forged);
    CycleRecord record;
    record.segment_start = true;
    writer.cycle(record, command);
    writer.close();
    const Replayed replayed = replay(bad.path());
    CHECK(replayed.problem == "");
    CHECK(replayed.bits.empty());
    CHECK(replayed.damage.find("no servo step can have") != std::string::npos);
}

TEST_CASE("replay: another build, another schema or no file at all is told with the reason") {
    const TemporaryFile file;
    RecordingInfo info = describe_recording(ideal_settings());
    CHECK(why_no_replay(info) == "");
    info.build ^= 1U;
    RecordingWriter writer;
    REQUIRE(writer.open(file.path(), info) == "");
    writer.close();
    Replay unread;
    CHECK(unread.load(file.path()) == "");
    CHECK(unread.why_poses_only().find("another build") != std::string::npos);
    info = describe_recording(ideal_settings());
    ++info.command_words;
    CHECK(why_no_replay(info).find("another form") != std::string::npos);
    info = describe_recording(ideal_settings());
    ++info.state_bytes;
    CHECK(why_no_replay(info).find("another form") != std::string::npos);
    info = describe_recording(ideal_settings());
    info.settings.tension.simd = static_cast<SimdLevel>(2); // AVX-512, of versions before this one
    CHECK(why_no_replay(info).find("made at vector level 2 (unknown vectors)") !=
          std::string::npos);
    info = describe_recording(ideal_settings());
    info.settings.rate_hz = -1.0;
    REQUIRE(writer.open(file.path(), info) == "");
    writer.close();
    CHECK(unread.load(file.path()).find("rate_hz") != std::string::npos);
    CHECK(unread.load(file.path() + ".absent").find("does not exist") != std::string::npos);
    Session session;
    CHECK(session.loop->start_recording(file.path()).find("No device") != std::string::npos);
    REQUIRE(session.loop->start_stepped(session.settings) == Status::ok);
    const std::string nowhere = file.path() + "_no_folder/a.rec";
    CHECK(session.loop->start_recording(nowhere).find("No such file") != std::string::npos);
    CHECK_FALSE(session.loop->recording());
}
