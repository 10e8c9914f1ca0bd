#include "bench/contact_peers.h"

#include <cstdio>

#include <dlfcn.h>

namespace spidar::bench {

std::vector<ContactPeer> contact_peers() {
    std::vector<ContactPeer> peers;
    for (const char *name : {"jolt", "fcl", "bullet"}) {
        const std::string path = std::string("build/peers/lib") + name + "_contacts.so";
        void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) {
            std::fprintf(stderr,
                         "spidar_bench: no %s: run python3 tests/bench/peers/fetch_peers.py "
                         "--contacts, then this from the root of the repository.\n",
                         path.c_str());
            continue;
        }
        const auto peer_name = reinterpret_cast<const char *(*)()>(dlsym(library, "peer_name"));
        peers.push_back({peer_name(),
                         reinterpret_cast<ContactPeer::Shape>(dlsym(library, "peer_shape")),
                         reinterpret_cast<ContactPeer::Distance>(dlsym(library, "peer_distance"))});
    }
    return peers;
}

} // namespace spidar::bench
