#include "device/recording/codec/cycle_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/reading_fields.h"
#include "device/recording/codec/touch_words.h"

namespace spidar {

namespace {

// Flags for what follows in a cycle. The most frequent come first, so that the flags mostly take
// one byte.
constexpr std::uint64_t kCounts = 1;
constexpr std::uint64_t kTensions = 2;
constexpr std::uint64_t kReading = 4; // the rest of the reading differs from the expected one
constexpr std::uint64_t kTimeStep = 8;
constexpr std::uint64_t kCommand = 16;
constexpr std::uint64_t kState = 32;
constexpr std::uint64_t kReadStatus = 64;
constexpr std::uint64_t kWriteStatus = 128;
constexpr std::uint64_t kMayArm = 256; // the flag itself, not a change of it
constexpr std::uint64_t kSegment = 512;
constexpr std::uint64_t kTouch = 1024; // the scene differs from that of the last command
constexpr std::uint64_t kAllFlags = 2047;

// Indices of clock and sequence number in the list of a reading.
constexpr std::size_t kClockWord = 0;
constexpr std::size_t kSequenceWord = 1;
constexpr std::size_t kLeastReadingWords = 2;

constexpr int kDigestBytes = 4;
constexpr int kWordBytes = 8;
constexpr double kNanosecond_s = 1e-9;
constexpr double kLongestWhole_ns = 1e15; // llround() of larger values is not exact

std::int32_t difference(std::int32_t a, std::int32_t b) noexcept { // wraps, as the counts do
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

std::int32_t sum(std::int32_t a, std::int64_t b) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

// Measured time steps are whole nanoseconds and take three bytes. Any other value is stored as it
// is.
void encode_time_step(double dt_s, ByteWriter &to) {
    const double steps = dt_s / kNanosecond_s;
    if (std::abs(steps) < kLongestWhole_ns) {
        const auto whole = static_cast<std::int64_t>(std::llround(steps));
        if (std::bit_cast<std::uint64_t>(static_cast<double>(whole) * kNanosecond_s) ==
            std::bit_cast<std::uint64_t>(dt_s)) {
            to.varint(zigzag(whole) << 1U);
            return;
        }
    }
    to.varint(1);
    to.fixed(std::bit_cast<std::uint64_t>(dt_s), kWordBytes);
}

double decode_time_step(ByteReader &from) noexcept {
    const std::uint64_t head = from.varint();
    if (head == 1) {
        return std::bit_cast<double>(from.fixed(kWordBytes));
    }
    return static_cast<double>(from_zigzag(head >> 1U)) * kNanosecond_s;
}

// Returns the reading that is expected when nothing happens: clock and sequence number continue as
// before.
DeviceReading expected_after(const DeviceReading &before, std::uint64_t clock_step_us) noexcept {
    DeviceReading expected = before;
    expected.device_time_us += clock_step_us;
    ++expected.sequence;
    return expected;
}

// Writes the changes in a row of words: pairs (words skipped, change), ended by a skip to the end.
void encode_changes(std::span<const std::uint64_t> words, std::span<const std::uint64_t> before,
                    ByteWriter &to) {
    std::size_t done = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] != before[i]) {
            to.varint(i - done);
            to.sparse_word(words[i] ^ before[i]);
            done = i + 1;
        }
    }
    to.varint(words.size() - done);
}

void decode_changes(ByteReader &from, std::span<std::uint64_t> words) noexcept {
    std::size_t next = 0;
    while (from.good()) {
        const std::uint64_t skipped = from.varint();
        if (skipped >= words.size() - next) {
            return;
        }
        next += static_cast<std::size_t>(skipped);
        words[next] ^= from.sparse_word();
        ++next;
    }
}

} // namespace

CycleEncoder::CycleEncoder()
    : last_command_(count_fields(HapticCommand{})), command_(last_command_.size()),
      last_touch_(count_touch_words()), touch_(last_touch_.size()),
      reading_(count_fields(DeviceReading{})), expected_(reading_.size()) {}

void CycleEncoder::encode(const CycleRecord &record, const HapticCommand &command, ByteWriter &to) {
    if (record.segment_start) { // readable without the cycles before
        last_ = CycleRecord();
        last_tensions_mn_ = {};
        last_clock_step_us_ = 0;
        last_command_.assign(last_command_.size(), 0);
        last_touch_.assign(last_touch_.size(), 0);
        touch_ = last_touch_;
    }
    const CycleInput &now = record.input;
    const CycleInput &before = last_.input;
    const CycleState &state = record.output;
    store_words(expected_after(before.reading, last_clock_step_us_), expected_);
    store_words(now.reading, reading_);
    const MillinewtonArray tensions_mn = millinewtons_of(record.output);
    const bool whole_command = record.segment_start || record.command_is_new;
    if (record.segment_start || (whole_command && command.touch_sequence != last_touch_sequence_)) {
        store_touch(command.touch, touch_);
        last_touch_sequence_ = command.touch_sequence;
    }

    std::uint64_t flags = 0;
    flags |= now.reading.counts != before.reading.counts ? kCounts : 0;
    flags |= tensions_mn != last_tensions_mn_ ? kTensions : 0;
    flags |= reading_ != expected_ ? kReading : 0;
    flags |= std::bit_cast<std::uint64_t>(now.dt_s) != std::bit_cast<std::uint64_t>(before.dt_s)
                 ? kTimeStep
                 : 0;
    flags |= whole_command ? kCommand : 0;
    flags |= state == last_.output ? 0 : kState;
    flags |= now.read_status != before.read_status ? kReadStatus : 0;
    flags |= now.write_status != before.write_status ? kWriteStatus : 0;
    flags |= now.may_arm_itself ? kMayArm : 0;
    flags |= record.segment_start ? kSegment : 0;
    flags |= whole_command && touch_ != last_touch_ ? kTouch : 0;

    to.varint(flags);
    if ((flags & kSegment) != 0) {
        to.varint(record.tick);
    }
    if ((flags & kCounts) != 0) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            to.signed_varint(difference(now.reading.counts[i], before.reading.counts[i]));
        }
    }
    if ((flags & kReading) != 0) {
        for (std::size_t i = 0; i < reading_.size(); ++i) {
            to.sparse_word(reading_[i] ^ expected_[i]);
        }
    }
    if ((flags & kTimeStep) != 0) {
        encode_time_step(now.dt_s, to);
    }
    if ((flags & kReadStatus) != 0) {
        to.signed_varint(static_cast<std::int32_t>(now.read_status));
    }
    if ((flags & kWriteStatus) != 0) {
        to.signed_varint(static_cast<std::int32_t>(now.write_status));
    }
    if ((flags & kCommand) != 0) {
        store_words(command, command_);
        encode_changes(command_, last_command_, to);
        last_command_ = command_;
    }
    if ((flags & kTouch) != 0) {
        encode_changes(touch_, last_touch_, to);
        last_touch_ = touch_;
    }
    if ((flags & kTensions) != 0) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            to.signed_varint(difference(tensions_mn[i], last_tensions_mn_[i]));
        }
    }
    if ((flags & kState) != 0) {
        to.fixed(static_cast<std::uint64_t>(state.state), 1);
        to.fixed(static_cast<std::uint64_t>(state.grasp) | (state.motors_on ? 0x80U : 0U), 1);
        to.signed_varint(state.fault_string);
        to.signed_varint(static_cast<std::int32_t>(state.fault));
        to.signed_varint(static_cast<std::int32_t>(state.pose_status));
        to.signed_varint(static_cast<std::int32_t>(state.tension_status));
    }
    to.fixed(digest_of(record.output), kDigestBytes);
    last_clock_step_us_ = now.reading.device_time_us - before.reading.device_time_us;
    last_ = record;
    last_tensions_mn_ = tensions_mn;
}

CycleDecoder::CycleDecoder(std::size_t command_words, std::size_t reading_words,
                           std::size_t touch_words)
    : reading_(std::max(reading_words, kLeastReadingWords)), touch_(touch_words) {
    last_.command_words.resize(command_words);
}

void CycleDecoder::decode_reading(bool told, ByteReader &from) {
    const std::uint64_t clock_before_us = reading_[kClockWord];
    reading_[kClockWord] += last_clock_step_us_;
    reading_[kSequenceWord] = static_cast<std::uint16_t>(reading_[kSequenceWord] + 1);
    if (told) {
        for (std::uint64_t &word : reading_) {
            word ^= from.sparse_word();
        }
    }
    last_clock_step_us_ = reading_[kClockWord] - clock_before_us;
    std::size_t next = 0;
    for_each_field(last_.input.reading, [this, &next](std::string_view, int, auto &field) {
        if (next < reading_.size()) {
            from_word(reading_[next], field);
        }
        ++next;
    });
}

void CycleDecoder::start_segment(ByteReader &from) {
    RecordedCycle fresh;
    fresh.command_words.assign(last_.command_words.size(), 0);
    fresh.segment_start = true;
    fresh.command_is_new = true;
    fresh.touch_is_new = true;
    fresh.tick = from.varint();
    last_ = fresh;
    last_clock_step_us_ = 0;
    std::vector<std::uint64_t> words(count_fields(DeviceReading{}));
    store_words(DeviceReading{}, words);
    words.resize(reading_.size());
    reading_ = words;
    touch_.assign(touch_.size(), 0);
}

void CycleDecoder::decode_inputs(std::uint64_t flags, ByteReader &from) {
    CycleInput &input = last_.input;
    if ((flags & kCounts) != 0) {
        for (std::int32_t &count : input.reading.counts) {
            count = sum(count, from.signed_varint());
        }
    }
    decode_reading((flags & kReading) != 0, from);
    if ((flags & kTimeStep) != 0) {
        input.dt_s = decode_time_step(from);
    }
    if ((flags & kReadStatus) != 0) {
        input.read_status = static_cast<Status>(from.signed_varint());
    }
    if ((flags & kWriteStatus) != 0) {
        input.write_status = static_cast<Status>(from.signed_varint());
    }
    input.may_arm_itself = (flags & kMayArm) != 0;
}

bool CycleDecoder::decode(ByteReader &from, RecordedCycle &cycle) {
    const std::uint64_t flags = from.varint();
    if (flags > kAllFlags) {
        return false;
    }
    last_.segment_start = (flags & kSegment) != 0;
    last_.command_is_new = (flags & kCommand) != 0;
    last_.touch_is_new = (flags & (kSegment | kTouch)) != 0;
    if (last_.segment_start) {
        start_segment(from);
    } else {
        ++last_.tick;
    }
    decode_inputs(flags, from);
    if ((flags & kCommand) != 0) {
        decode_changes(from, last_.command_words);
    }
    if ((flags & kTouch) != 0) {
        decode_changes(from, touch_);
    }
    if ((flags & kTensions) != 0) {
        for (std::int32_t &tension_mn : last_.tensions_mn) {
            tension_mn = sum(tension_mn, from.signed_varint());
        }
    }
    if ((flags & kState) != 0) {
        last_.state = static_cast<DeviceState>(from.fixed(1));
        const std::uint64_t phase = from.fixed(1);
        last_.grasp = static_cast<GraspPhase>(phase & 0x7FU);
        last_.motors_on = (phase & 0x80U) != 0;
        last_.fault_string = static_cast<std::int8_t>(from.signed_varint());
        last_.fault = static_cast<Status>(from.signed_varint());
        last_.pose_status = static_cast<Status>(from.signed_varint());
        last_.tension_status = static_cast<Status>(from.signed_varint());
    }
    last_.digest = static_cast<std::uint32_t>(from.fixed(kDigestBytes));
    cycle = last_;
    return from.good();
}

} // namespace spidar
