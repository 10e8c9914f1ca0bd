#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "device/recording/recording_file.h"

namespace spidar {

namespace {

// A chunk of cycles is written when it has grown to this size, or at the next flush().
constexpr std::size_t kFullChunk_bytes = 32'768;
constexpr int kNumberBytes = 4;

} // namespace

std::string RecordingWriter::open(const std::string &path, const RecordingInfo &info) {
    // Paths are UTF-8 on every system.
    const std::filesystem::path place(std::u8string(path.begin(), path.end()));
    file_ = std::ofstream(place, std::ios::binary | std::ios::trunc);
    if (!file_) {
        return "The recording \"" + path +
               "\" cannot be created: " + std::generic_category().message(errno) +
               ". Choose a file in a folder that exists and that you may write to.";
    }
    encoder_ = CycleEncoder();
    pending_.clear();
    pending_.reserve(2 * kFullChunk_bytes);
    pending_reads_.clear();
    last_read_ = GameRead();
    number_ = 0;
    cycles_ = 0;
    lost_ = 0;
    bytes_ = kRecordingMagic.size();
    good_ = true;
    file_.write(reinterpret_cast<const char *>(kRecordingMagic.data()), kRecordingMagic.size());
    const std::string text = to_text(info);
    chunk(ChunkKind::info, {reinterpret_cast<const std::uint8_t *>(text.data()), text.size()});
    flush();
    return good_ ? std::string()
                 : "The recording \"" + path +
                       "\" cannot be written; check whether the disk is full.";
}

void RecordingWriter::chunk(ChunkKind kind, std::span<const std::uint8_t> contents) {
    if (!good_) {
        return;
    }
    chunk_.clear();
    ByteWriter to(chunk_);
    to.fixed(static_cast<std::uint64_t>(kind), 1);
    to.fixed(number_, kNumberBytes);
    to.fixed(contents.size(), kNumberBytes);
    to.raw(contents);
    to.fixed(crc32(chunk_), kNumberBytes);
    file_.write(reinterpret_cast<const char *>(chunk_.data()),
                static_cast<std::streamsize>(chunk_.size()));
    ++number_;
    bytes_ += chunk_.size();
    good_ = file_.good();
}

void RecordingWriter::memory(std::span<const std::uint8_t> bytes) {
    flush();
    chunk(ChunkKind::memory, bytes);
}

void RecordingWriter::shape_chunks(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kPiece_bytes = kMostChunkBytes - 1;
    std::vector<std::uint8_t> contents;
    do {
        const std::size_t size = std::min(bytes.size(), kPiece_bytes);
        contents.clear();
        ByteWriter to(contents);
        to.fixed(size < bytes.size() ? 1 : 0, 1);
        to.raw(bytes.first(size));
        chunk(ChunkKind::shape, contents);
        bytes = bytes.subspan(size);
    } while (!bytes.empty());
}

void RecordingWriter::shape(const CookedShape &shape) {
    std::vector<std::uint8_t> bytes;
    ByteWriter to(bytes);
    encode_shape(shape, to);
    shape_chunks(bytes);
}

void RecordingWriter::shape(const ToolShape &tool) {
    std::vector<std::uint8_t> bytes;
    ByteWriter to(bytes);
    encode_shape(tool, to);
    shape_chunks(bytes);
}

void RecordingWriter::cycle(const CycleRecord &record, const HapticCommand &command) {
    ByteWriter to(pending_);
    encoder_.encode(record, command, to);
    ++cycles_;
    if (pending_.size() >= kFullChunk_bytes) {
        flush();
    }
}

void RecordingWriter::read(const GameRead &read) {
    ByteWriter to(pending_reads_);
    to.varint(((read.tick - last_read_.tick) << 1U) | (read.physics_tick ? 1U : 0U));
    to.varint(read.contacts_sequence - last_read_.contacts_sequence);
    last_read_ = read;
}

void RecordingWriter::gap(std::uint64_t cycles_lost) {
    flush();
    std::vector<std::uint8_t> contents;
    ByteWriter(contents).varint(cycles_lost);
    chunk(ChunkKind::gap, contents);
    lost_ += cycles_lost;
}

void RecordingWriter::flush() {
    if (!pending_.empty()) {
        chunk(ChunkKind::cycles, pending_);
        pending_.clear();
    }
    if (!pending_reads_.empty()) {
        chunk(ChunkKind::reads, pending_reads_);
        pending_reads_.clear();
    }
    if (good_) {
        file_.flush();
        good_ = file_.good();
    }
}

void RecordingWriter::close() {
    if (!file_.is_open()) {
        return;
    }
    flush();
    std::vector<std::uint8_t> contents;
    ByteWriter to(contents);
    to.varint(cycles_);
    to.varint(lost_);
    chunk(ChunkKind::end, contents);
    file_.close();
    good_ = good_ && !file_.fail();
}

} // namespace spidar
