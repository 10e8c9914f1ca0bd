// The queue between the servo loop and the recorder.
#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <thread>

#include "device/threads/spsc_ring.h"

using spidar::SpscRing;

TEST_CASE("spsc ring: first in, first out; full refuses; empty gives nothing") {
    SpscRing<int> ring(5);
    CHECK(ring.capacity() == 8);
    CHECK(ring.oldest() == nullptr);
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 8; ++i) {
            int *const slot = ring.free_slot();
            REQUIRE(slot != nullptr);
            *slot = 10 * round + i;
            ring.commit();
        }
        CHECK(ring.free_slot() == nullptr);
        CHECK(ring.size() == 8);
        for (int i = 0; i < 8; ++i) {
            const int *const value = ring.oldest();
            REQUIRE(value != nullptr);
            CHECK(*value == 10 * round + i);
            ring.pop();
        }
        CHECK(ring.oldest() == nullptr);
        CHECK(ring.size() == 0);
    }
}

TEST_CASE("spsc ring: two threads hand over every element, in order and whole") {
    struct Pair {
        std::uint64_t a = 0;
        std::uint64_t b = 0;
    };
    constexpr std::uint64_t kElements = 200'000;
    SpscRing<Pair> ring(64);
    std::thread writer([&ring] {
        for (std::uint64_t i = 1; i <= kElements;) {
            Pair *const slot = ring.free_slot();
            if (slot == nullptr) {
                std::this_thread::yield();
                continue;
            }
            *slot = {i, ~i};
            ring.commit();
            ++i;
        }
    });
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 1; i <= kElements;) {
        const Pair *const pair = ring.oldest();
        if (pair == nullptr) {
            std::this_thread::yield();
            continue;
        }
        wrong += pair->a != i || pair->b != ~i ? 1U : 0U;
        ring.pop();
        ++i;
    }
    writer.join();
    CHECK(wrong == 0);
    CHECK(ring.oldest() == nullptr);
}

TEST_CASE("spsc ring: offered and taken in order across threads; a full one drops the newest") {
    constexpr int kPlaces = 256;
    SpscRing<double> queue(kPlaces);
    int dropped = 0;
    for (int i = 0; i < 300; ++i) {
        dropped += queue.offer(i) ? 0 : 1;
    }
    CHECK(dropped == 300 - kPlaces);
    double value = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        REQUIRE(queue.take(value));
        CHECK(value == i);
    }
    CHECK_FALSE(queue.take(value));

    SpscRing<double> busy(kPlaces);
    std::atomic<int> lost{0};
    constexpr int kMany = 100000;
    std::thread writer([&] {
        for (int i = 1; i <= kMany; ++i) {
            lost += busy.offer(i) ? 0 : 1;
        }
    });
    double last = 0.0;
    int got = 0;
    bool ordered = true;
    while (last < kMany && got + lost < kMany) {
        if (busy.take(value)) {
            ordered = ordered && value > last;
            last = value;
            ++got;
        }
    }
    writer.join();
    CHECK(ordered);
}
