#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "device/threads/triple_buffer.h"

using spidar::TripleBuffer;

namespace {

// All words alike: a torn value would show as two different ones.
struct Block {
    std::array<std::uint64_t, 40> words{};
};

} // namespace

TEST_CASE("triple buffer: nothing to read before the first write, newest wins, read once") {
    TripleBuffer<int> buffer;
    int value = -1;
    CHECK_FALSE(buffer.read(value));
    CHECK(value == -1);
    buffer.write(1);
    buffer.write(2);
    CHECK(buffer.read(value));
    CHECK(value == 2);
    CHECK_FALSE(buffer.read(value));
    buffer.write(3);
    CHECK(buffer.read(value));
    CHECK(value == 3);
}

TEST_CASE("triple buffer: two threads, a million writes, never torn, never older than before") {
    constexpr std::uint64_t kWrites = 1'000'000;
    TripleBuffer<Block> buffer;
    std::thread writer([&buffer] {
        Block block;
        for (std::uint64_t n = 1; n <= kWrites; ++n) {
            block.words.fill(n);
            buffer.write(block);
        }
    });
    std::uint64_t torn = 0;
    std::uint64_t backwards = 0;
    std::uint64_t reads = 0;
    std::uint64_t last = 0;
    Block block;
    while (last < kWrites) {
        if (!buffer.read(block)) {
            std::this_thread::yield();
            continue;
        }
        ++reads;
        for (const std::uint64_t word : block.words) {
            torn += word != block.words[0] ? 1U : 0U;
        }
        backwards += block.words[0] <= last ? 1U : 0U;
        last = block.words[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(backwards == 0);
    CHECK(reads > 0);
    CHECK(last == kWrites); // the newest value is never lost
}
