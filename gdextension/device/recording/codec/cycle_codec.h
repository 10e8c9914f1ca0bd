// Cycles as few bytes: each is written as its difference from the one before.
#pragma once

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
    // As last recorded, word by word (command_fields.h).
    std::vector<std::uint64_t> command_words;
    MillinewtonArray tensions_mn{};
    std::uint32_t digest = 0; // of the whole output
};

class CycleEncoder {
public:
    CycleEncoder();
    // command: the one in force; looked at when the record starts a segment or its command is new.
    void encode(const CycleRecord &record, const HapticCommand &command, ByteWriter &to);

private:
    void encode_command(const HapticCommand &command, ByteWriter &to);

    CycleRecord last_;
    MillinewtonArray last_tensions_mn_{};
    std::uint64_t last_clock_step_us_ = 0;
    std::vector<std::uint64_t> last_command_;
    std::vector<std::uint64_t> command_;
    std::vector<std::uint64_t> reading_;
    std::vector<std::uint64_t> expected_;
};

class CycleDecoder {
public:
    // How many words a command and the rest of a reading had when the recording was made. Of a reading with other
    // fields than this build knows, the known ones are kept: new fields are added at the end of the list.
    CycleDecoder(std::size_t command_words, std::size_t reading_words);
    // False: these bytes are no cycle; `cycle` then means nothing.
    bool decode(ByteReader &from, RecordedCycle &cycle);

private:
    void start_segment(ByteReader &from);
    void decode_inputs(std::uint64_t flags, ByteReader &from);
    void decode_reading(bool told, ByteReader &from);
    void decode_command(ByteReader &from);

    RecordedCycle last_;
    std::uint64_t last_clock_step_us_ = 0;
    std::vector<std::uint64_t> reading_; // the rest of the last reading
};

} // namespace spidar
