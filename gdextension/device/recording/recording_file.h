// The file of a recording. It consists of chunks with kind, number, size and a CRC-32. A file that
// was cut or damaged is read up to the damage and never beyond.
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

// Kind of a chunk. A chunk has kind (1 byte), number (4 bytes, from 0), size (4 bytes), contents,
// and the CRC-32 (4 bytes) of all these.
enum class ChunkKind : std::uint8_t {
    info = 1,   // text of RecordingInfo; the first chunk
    memory = 2, // bytes of the ServoStep before the next segment (recorder.h)
    cycles = 3,
    gap = 4, // number of cycles missing here (varint)
    // The recording was closed. Contents: number of cycles, number of missing cycles (varints).
    end = 5,
    // GameReads, two varints each: (cycles since the last read) * 2 + (1 for a physics tick);
    // contact sets since the last read.
    reads = 6,
    // A piece of a shape: one byte that is 1 when more pieces follow, then bytes of encode_shape().
    // The pieces of a shape are consecutive and precede the first cycle or memory that uses it.
    shape = 7,
};
inline constexpr std::array<std::uint8_t, 8> kRecordingMagic = {'S', 'P', 'I', 'D',
                                                                'A', 'R', 'G', '\n'};
inline constexpr std::size_t kChunkHeadBytes = 9;
inline constexpr std::size_t kChunkTailBytes = 4;
inline constexpr std::size_t kMostChunkBytes = 4'000'000;

class RecordingWriter {
public:
    // Opens the file and writes its head. Returns an empty string, or a text with path and remedy.
    [[nodiscard]] std::string open(const std::string &path, const RecordingInfo &info);

    void memory(std::span<const std::uint8_t> bytes);
    void shape(const CookedShape &shape);
    void shape(const ToolShape &tool);
    // See CycleEncoder::encode().
    void cycle(const CycleRecord &record, const HapticCommand &command);
    void read(const GameRead &read);
    void gap(std::uint64_t cycles_lost);
    // Passes all pending bytes to the operating system: they survive the end of the process.
    void flush();
    // Flushes, writes the end chunk and closes the file.
    void close();

    // False after the first failed write (disk full); nothing is written from then on.
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
    // Opens a file and reads info(). Returns an empty string, or a text with the reason of a
    // failure.
    [[nodiscard]] std::string open(const std::string &path);
    // Opens a stream; `name` appears in messages.
    [[nodiscard]] std::string open(std::unique_ptr<std::istream> stream, const std::string &name);

    // Called after open(): stores the file's shapes as they are read. Null: shapes are skipped.
    void keep_shapes(RecordedShapes *shapes) noexcept { shapes_ = shapes; }

    // Reads the next cycle. Returns false at the end or at damage; closed() is true only when the
    // recording was ended properly. A reader reads either cycles or game reads: use two readers for
    // both.
    [[nodiscard]] bool next(RecordedCycle &cycle);
    // Reads the next GameRead. Returns false when there is none before the end or the damage.
    [[nodiscard]] bool next(GameRead &read);

    [[nodiscard]] const RecordingInfo &info() const noexcept { return info_; }
    // Bytes of the ServoStep before the segment to which the last cycle belongs.
    [[nodiscard]] std::span<const std::uint8_t> memory() const noexcept { return memory_; }
    // The scene of the last cycle's command, as words of codec/touch_words.h.
    [[nodiscard]] std::span<const std::uint64_t> touch_words() const noexcept {
        return decoder_.touch_words();
    }
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
    [[nodiscard]] bool closed() const noexcept { return closed_; }
    // After reading stopped at damage or at the end of a file that was not closed: one sentence
    // with the place and the number of cycles before it. Else empty.
    [[nodiscard]] const std::string &damage() const noexcept { return damage_; }

private:
    // Reads a chunk. Returns false when no whole chunk is left; damage_ then holds the reason.
    bool read_chunk(ChunkKind &kind);
    bool take(ChunkKind kind);
    bool take_shape();
    void give_up(const std::string &what);

    std::unique_ptr<std::istream> file_;
    std::uint64_t place_ = 0; // bytes read in whole chunks
    std::uint64_t file_bytes_ = 0;
    std::uint32_t number_ = 0;
    RecordingInfo info_;
    std::vector<std::uint8_t> chunk_; // contents of the current chunk
    std::vector<std::uint8_t> memory_;
    ByteReader cycles_left_;
    ByteReader reads_left_;
    GameRead last_read_;
    CycleDecoder decoder_{0, 0, 0};
    RecordedShapes *shapes_ = nullptr;
    std::vector<std::uint8_t> shape_; // pieces of an incomplete shape
    std::uint64_t cycles_ = 0;
    std::uint64_t lost_ = 0;
    bool closed_ = false;
    std::string damage_;
};

} // namespace spidar
