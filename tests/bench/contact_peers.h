// Distance queries of others, in shared libraries under build/peers/ (tests/bench/peers/fetch_peers.py --contacts makes
// them from tests/bench/peers/), opened at run time.
#pragma once

#include <string>
#include <vector>

namespace spidar::bench {

struct ContactPeer {
    using Shape = void *(*)(int kind, const double *size, const double *points, int point_count,
                            const unsigned *indices, int triangle_count);
    using Distance = double (*)(void *a, const double *pose_a, void *b, const double *pose_b,
                                double *normal);

    std::string name;
    Shape shape = nullptr;
    Distance distance = nullptr;
};

// Those that are there; a sentence on stderr for each that is not.
[[nodiscard]] std::vector<ContactPeer> contact_peers();

} // namespace spidar::bench
