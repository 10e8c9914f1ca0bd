// The file of a recording: chunks, each with its kind, number, size and a CRC-32 over all of it, so that a file that was
// cut or damaged is read up to the damage and never beyond.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/recording/codec/cycle_codec.h"
#include "device/recording/codec/recorded_shapes.h"
#include "device/recording/recording_info.h"

namespace spidar {

// Chunk: kind 1 byte, number 4 bytes (counts from 0), size 4 bytes, contents, CRC-32 of all that: 4 bytes.
enum class ChunkKind : std::uint8_t {
    info = 1,   // text of RecordingInfo; the first chunk
    memory = 2, // the servo step's memory, byte for byte, before the segment that follows
    cycles = 3,
    gap = 4, // so many cycles are missing here (varint)
    end = 5, // the recording was closed; cycles in it, cycles missing (varints)
    // GameReads, two varints each: cycles since the read before, times 2, plus 1 for a physics tick; sets of contacts
    // since the read before.
    reads = 6,
    // A piece of a shape: a byte that is 1 when more pieces of it follow, then bytes of encode_shape(). The pieces of a shape
    // stand together, before the first cycle or memory that has it.
    shape = 7,
};
inline constexpr std::array<std::uint8_t, 8> kRecordingMagic = {'S', 'P', 'I', 'D',
                                                                'A', 'R', 'G', '\n'};
inline constexpr std::size_t kChunkHeadBytes = 9;
inline constexpr std::size_t kChunkTailBytes = 4;
inline constexpr std::size_t kMostChunkBytes = 4'000'000;

class RecordingWriter {
public:
    // Empty: open, and the head is written. Else one sentence with the path and the remedy.
    [[nodiscard]] std::string open(const std::string &path, const RecordingInfo &info);

    void memory(std::span<const std::uint8_t> bytes);
    void shape(const CookedShape &shape);
    void shape(const ToolShape &tool);
    // As CycleEncoder::encode().
    void cycle(const CycleRecord &record, const HapticCommand &command);
    void read(const GameRead &read);
    void gap(std::uint64_t cycles_lost);
    // What is waiting goes to the system: a process that is killed later does not lose it.
    void flush();
    // flush(), the end mark, and the file is closed.
    void close();

    // False from the first failed write on (disk full): nothing is written any more.
    [[nodiscard]] bool good() const noexcept { return good_; }
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

private:
    void chunk(ChunkKind kind, std::span<const std::uint8_t> contents);
    void shape_chunks(std::span<const std::uint8_t> bytes);

    std::ofstream file_;
    CycleEncoder encoder_;
    std::vector<std::uint8_t> pending_;
    std::vector<std::uint8_t> pending_reads_;
    GameRead last_read_;
    std::vector<std::uint8_t> chunk_;
    std::uint32_t number_ = 0;
    std::uint64_t cycles_ = 0;
    std::uint64_t lost_ = 0;
    std::uint64_t bytes_ = 0;
    bool good_ = false;
};

class RecordingReader {
public:
    // Empty: open, info() is known, and next() gives the first cycle. Else one sentence.
    [[nodiscard]] std::string open(const std::string &path);
    // The same for bytes from anywhere; `name` stands in messages.
    [[nodiscard]] std::string open(std::unique_ptr<std::istream> stream, const std::string &name);

    // Once open: the shapes of the file go there as they are read. Without it they are passed over.
    void keep_shapes(RecordedShapes *shapes) noexcept { shapes_ = shapes; }

    // A reader gives either the cycles of a file or the game's reads: the two passes have a reader each.
    // Reads the next cycle. False at the end of the recording, or where the file is damaged: closed() is true only when
    // the recording was ended properly.
    [[nodiscard]] bool next(RecordedCycle &cycle);
    // Reads the game's next read. False: there is none before the end or the damage.
    [[nodiscard]] bool next(GameRead &read);

    [[nodiscard]] const RecordingInfo &info() const noexcept { return info_; }
    // The memory of the servo step just before the segment that the last cycle read belongs to.
    [[nodiscard]] std::span<const std::uint8_t> memory() const noexcept { return memory_; }
    // The scene of the last cycle's command, as codec/touch_words.h has it.
    [[nodiscard]] std::span<const std::uint64_t> touch_words() const noexcept {
        return decoder_.touch_words();
    }
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
    [[nodiscard]] bool closed() const noexcept { return closed_; }
    // At the end of a file that was not closed: one sentence with the place and what is left. Else empty.
    [[nodiscard]] const std::string &damage() const noexcept { return damage_; }

private:
    // False: no whole chunk is left, and damage_ says why.
    bool read_chunk(ChunkKind &kind);
    bool take(ChunkKind kind);
    bool take_shape();
    void give_up(const std::string &what);

    std::unique_ptr<std::istream> file_;
    std::uint64_t place_ = 0; // bytes read in whole chunks
    std::uint64_t file_bytes_ = 0;
    std::uint32_t number_ = 0;
    RecordingInfo info_;
    std::vector<std::uint8_t> chunk_; // contents of the one being read
    std::vector<std::uint8_t> memory_;
    ByteReader cycles_left_;
    ByteReader reads_left_;
    GameRead last_read_;
    CycleDecoder decoder_{0, 0, 0};
    RecordedShapes *shapes_ = nullptr;
    std::vector<std::uint8_t> shape_; // pieces of one that is not whole yet
    std::uint64_t cycles_ = 0;
    std::uint64_t lost_ = 0;
    bool closed_ = false;
    std::string damage_;
};

} // namespace spidar
