// Cycles as few bytes: each is written as its difference from the one before.
#pragma once

#include <span>
#include <vector>

#include "device/contract/haptic_command.h"
#include "device/recording/codec/byte_codec.h"
#include "device/recording/codec/cycle_record.h"

namespace spidar {

// What a file says about one cycle.
struct RecordedCycle : CycleState {
    CycleInput input;
    std::uint64_t tick = 0;
    bool segment_start = false;
    bool command_is_new = false;
    bool touch_is_new = false; // CycleDecoder::touch_words() have changed
    // As last recorded, word by word (command_fields.h).
    std::vector<std::uint64_t> command_words;
    MillinewtonArray tensions_mn{};
    std::uint32_t digest = 0; // of the whole output
};

class CycleEncoder {
public:
    CycleEncoder();
    // command: the one in force; looked at when the record starts a segment or its command is new. The scene that it points
    // to is looked at then too, if its number is new.
    void encode(const CycleRecord &record, const HapticCommand &command, ByteWriter &to);

private:
    CycleRecord last_;
    MillinewtonArray last_tensions_mn_{};
    std::uint64_t last_clock_step_us_ = 0;
    std::vector<std::uint64_t> last_command_;
    std::vector<std::uint64_t> command_;
    std::uint64_t last_touch_sequence_ = 0;
    std::vector<std::uint64_t> last_touch_; // touch_words.h
    std::vector<std::uint64_t> touch_;
    std::vector<std::uint64_t> reading_;
    std::vector<std::uint64_t> expected_;
};

class CycleDecoder {
public:
    // How many words a command, the rest of a reading and a scene had when the recording was made. Of a reading with other
    // fields than this build knows, the known ones are kept: new fields are added at the end of the list.
    CycleDecoder(std::size_t command_words, std::size_t reading_words, std::size_t touch_words);
    // False: these bytes are no cycle; `cycle` then means nothing.
    bool decode(ByteReader &from, RecordedCycle &cycle);
    // The scene in force, as touch_words.h has it.
    [[nodiscard]] std::span<const std::uint64_t> touch_words() const noexcept { return touch_; }

private:
    void start_segment(ByteReader &from);
    void decode_inputs(std::uint64_t flags, ByteReader &from);
    void decode_reading(bool told, ByteReader &from);
    RecordedCycle last_;
    std::uint64_t last_clock_step_us_ = 0;
    std::vector<std::uint64_t> reading_; // the rest of the last reading
    std::vector<std::uint64_t> touch_;
};

} // namespace spidar
