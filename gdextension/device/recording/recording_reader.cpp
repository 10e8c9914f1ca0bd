#include <filesystem>
#include <system_error>

#include "device/recording/recording_file.h"

namespace spidar {

namespace {

constexpr int kNumberBytes = 4;

} // namespace

std::string RecordingReader::open(const std::string &path) {
    const std::filesystem::path place(std::u8string(path.begin(), path.end()));
    auto file = std::make_unique<std::ifstream>(place, std::ios::binary);
    if (!*file) {
        std::error_code problem;
        const bool exists = std::filesystem::exists(place, problem);
        return "The recording \"" + path + "\" cannot be opened: " +
               (exists ? "there is no permission to read it." : "the file does not exist.");
    }
    return open(std::move(file), path);
}

std::string RecordingReader::open(std::unique_ptr<std::istream> stream, const std::string &name) {
    *this = RecordingReader();
    file_ = std::move(stream);
    file_->seekg(0, std::ios::end);
    file_bytes_ = static_cast<std::uint64_t>(file_->tellg());
    file_->seekg(0);
    std::array<std::uint8_t, kRecordingMagic.size()> magic{};
    file_->read(reinterpret_cast<char *>(magic.data()), magic.size());
    if (!*file_ || magic != kRecordingMagic) {
        return "\"" + name +
               "\" is not a recording of spidar_g: its first bytes differ. Choose another file.";
    }
    place_ = magic.size();
    ChunkKind kind{};
    if (!read_chunk(kind) || kind != ChunkKind::info) {
        return "The recording \"" + name +
               "\" is damaged in its head, so nothing of it can be read.";
    }
    const std::string text(chunk_.begin(), chunk_.end());
    std::string problem = read_text(text, info_);
    if (problem.empty()) {
        decoder_ = CycleDecoder(static_cast<std::size_t>(info_.command_words),
                                static_cast<std::size_t>(info_.reading_words),
                                static_cast<std::size_t>(info_.touch_words));
    }
    return problem;
}

void RecordingReader::give_up(const std::string &what) {
    damage_ = "The recording " + what + " at byte " + std::to_string(place_) + " of " +
              std::to_string(file_bytes_) + "; the " + std::to_string(cycles_) +
              " cycles before it are intact.";
    cycles_left_ = ByteReader();
    reads_left_ = ByteReader();
}

bool RecordingReader::read_chunk(ChunkKind &kind) {
    std::array<std::uint8_t, kChunkHeadBytes> head{};
    file_->read(reinterpret_cast<char *>(head.data()), head.size());
    const auto got = static_cast<std::size_t>(file_->gcount());
    if (got != head.size()) {
        give_up(got == 0 ? "was not closed: it ends" : "is cut off");
        return false;
    }
    ByteReader from(head);
    kind = static_cast<ChunkKind>(from.fixed(1));
    const std::uint64_t number = from.fixed(kNumberBytes);
    const std::uint64_t size = from.fixed(kNumberBytes);
    if (number != number_ || size > kMostChunkBytes || kind < ChunkKind::info ||
        kind > ChunkKind::shape) {
        give_up("is damaged");
        return false;
    }
    chunk_.resize(static_cast<std::size_t>(size) + kChunkTailBytes);
    file_->read(reinterpret_cast<char *>(chunk_.data()),
                static_cast<std::streamsize>(chunk_.size()));
    if (static_cast<std::size_t>(file_->gcount()) != chunk_.size()) {
        give_up("is cut off");
        return false;
    }
    ByteReader tail(std::span<const std::uint8_t>(chunk_).last(kChunkTailBytes));
    const std::uint64_t stored = tail.fixed(kNumberBytes);
    chunk_.resize(static_cast<std::size_t>(size));
    if (crc32(chunk_, crc32(head)) != stored) {
        give_up("is damaged");
        return false;
    }
    ++number_;
    place_ += kChunkHeadBytes + size + kChunkTailBytes;
    return true;
}

bool RecordingReader::take_shape() {
    if (shapes_ == nullptr) {
        return true;
    }
    ByteReader from(chunk_);
    const bool more = from.fixed(1) != 0;
    const std::span<const std::uint8_t> piece = from.rest();
    shape_.insert(shape_.end(), piece.begin(), piece.end());
    if (more) {
        return true;
    }
    const bool good = shapes_->take(shape_);
    std::vector<std::uint8_t>().swap(shape_);
    if (!good) {
        give_up("holds a shape that cannot be made");
    }
    return good;
}

bool RecordingReader::take(ChunkKind kind) {
    ByteReader from(chunk_);
    if (kind != ChunkKind::shape && !shape_.empty()) {
        give_up("lacks a piece of a shape");
        return false;
    }
    switch (kind) {
    case ChunkKind::memory:
        memory_ = chunk_;
        return true;
    case ChunkKind::cycles:
        cycles_left_ = from;
        return true;
    case ChunkKind::gap:
        lost_ += from.varint();
        return true;
    case ChunkKind::end:
        closed_ = from.varint() == cycles_ && place_ == file_bytes_;
        if (!closed_) {
            give_up("goes on after its end, or lacks cycles,");
        }
        return false;
    case ChunkKind::reads:
        reads_left_ = from;
        return true;
    case ChunkKind::shape:
        return take_shape();
    case ChunkKind::info: // valid as the first chunk only
        break;
    }
    give_up("is damaged");
    return false;
}

bool RecordingReader::next(RecordedCycle &cycle) {
    while (cycles_left_.empty()) {
        ChunkKind kind{};
        if (closed_ || !damage_.empty() || !read_chunk(kind) || !take(kind)) {
            return false;
        }
    }
    if (!decoder_.decode(cycles_left_, cycle)) {
        give_up("holds a cycle that cannot be read");
        return false;
    }
    ++cycles_;
    return true;
}

bool RecordingReader::next(GameRead &read) {
    while (reads_left_.empty()) {
        ChunkKind kind{};
        if (!damage_.empty() || !read_chunk(kind) || kind == ChunkKind::end) {
            return false;
        }
        if (kind == ChunkKind::reads) {
            reads_left_ = ByteReader(chunk_);
        }
    }
    const std::uint64_t word = reads_left_.varint();
    const std::uint64_t sets = reads_left_.varint();
    if (!reads_left_.good()) {
        give_up("holds a read of the game that is not valid");
        return false;
    }
    last_read_.tick += word >> 1U;
    last_read_.physics_tick = (word & 1U) != 0;
    last_read_.contacts_sequence += sets;
    read = last_read_;
    return true;
}

} // namespace spidar
