// Encodes cycles compactly, each as its difference from the one before; the first of a segment is
// encoded in full.
#pragma once

#include <span>
#include <vector>

#include "device/contract/haptic_command.h"
#include "device/recording/codec/byte_codec.h"
#include "device/recording/codec/cycle_record.h"

namespace spidar {

// One cycle as read from a file.
struct RecordedCycle : CycleState {
    CycleInput input;
    std::uint64_t tick = 0;
    bool segment_start = false;
    bool command_is_new = false;
    bool touch_is_new = false; // CycleDecoder::touch_words() have changed
    // The last recorded command as words (command_fields.h).
    std::vector<std::uint64_t> command_words;
    MillinewtonArray tensions_mn{};
    // digest_of() the whole output.
    std::uint32_t digest = 0;
};

class CycleEncoder {
public:
    CycleEncoder();
    // Encodes a cycle. command: the command in force, which is read only if the record starts a
    // segment or its command is new. Its scene is then read only if a segment starts or the scene's
    // number is new.
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
    // Numbers of words of a command, of a reading without its counts, and of a scene in the
    // recording. Words of a reading beyond the fields of this build are dropped, since new fields
    // are only added at the end of the list.
    CycleDecoder(std::size_t command_words, std::size_t reading_words, std::size_t touch_words);
    // Returns false when the bytes are not a cycle; `cycle` is then undefined.
    bool decode(ByteReader &from, RecordedCycle &cycle);
    // The scene in force, as words of touch_words.h.
    [[nodiscard]] std::span<const std::uint64_t> touch_words() const noexcept { return touch_; }

private:
    void start_segment(ByteReader &from);
    void decode_inputs(std::uint64_t flags, ByteReader &from);
    void decode_reading(bool told, ByteReader &from);
    RecordedCycle last_;
    std::uint64_t last_clock_step_us_ = 0;
    std::vector<std::uint64_t> reading_; // the last reading without its counts
    std::vector<std::uint64_t> touch_;
};

} // namespace spidar
