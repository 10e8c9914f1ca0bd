#include "bench/library_peers.h"

#include <cstdio>

#include <dlfcn.h>

#include "bench/quadratic.h"
#include "core/base/simd_level.h"

namespace spidar::bench {

namespace {

constexpr const char *kDaqp = "DAQP 0.11.0";

class LibraryMethod : public TensionMethod {
public:
    LibraryMethod(const std::string &name, void *library, bool quick)
        : TensionMethod(name), quick_(quick),
          create_(reinterpret_cast<Create>(dlsym(library, "peer_create"))),
          solve_(reinterpret_cast<Solve>(dlsym(library, "peer_solve"))),
          free_(reinterpret_cast<Free>(dlsym(library, "peer_free"))) {}
    ~LibraryMethod() override {
        if (handle_ != nullptr) {
            free_(handle_);
        }
    }
    LibraryMethod(const LibraryMethod &) = delete;
    LibraryMethod &operator=(const LibraryMethod &) = delete;

    bool solve(const TensionProblem &problem, bool warm, StringArray &tensions_n) override {
        build_quadratic(problem, quadratic_);
        upper_ = problem.upper_n;
        lower_ = problem.lower_n;
        if (handle_ == nullptr) {
            handle_ = create_(&quadratic_.h[0][0], quadratic_.f, upper_.data(), lower_.data());
        }
        return handle_ != nullptr &&
               solve_(handle_, warm ? 1 : 0, quick_ ? 1 : 0, tensions_n.data()) > 0;
    }

private:
    using Create = void *(*)(double *, double *, double *, double *);
    using Solve = int (*)(void *, int, int, double *);
    using Free = void (*)(void *);

    bool quick_;
    Create create_;
    Solve solve_;
    Free free_;
    void *handle_ = nullptr;
    Quadratic quadratic_{};
    StringArray upper_{};
    StringArray lower_{};
};

struct Library {
    const char *file;
    std::string name;
    bool avx2;
};

// Null, with a sentence on stderr, when the library is not there; never closed.
void *open_library(const Library &library) {
    const std::string path = std::string("build/peers/lib") + library.file + ".so";
    void *handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        std::fprintf(stderr,
                     "spidar_bench: no %s: run python3 tests/bench/peers/fetch_peers.py, then "
                     "this from the root of the repository.\n",
                     path.c_str());
    }
    return handle;
}

bool runs_here(const Library &library) {
    return !library.avx2 || supports(SimdLevel::avx2);
}

} // namespace

std::vector<std::unique_ptr<TensionMethod>> daqp_methods() {
    std::vector<std::unique_ptr<TensionMethod>> methods;
    for (const Library &library :
         {Library{"daqp_plain", "plain", false}, Library{"daqp_avx2", "avx2", true}}) {
        void *handle = runs_here(library) ? open_library(library) : nullptr;
        if (handle != nullptr) {
            const std::string name = std::string(kDaqp) + ", " + library.name;
            methods.push_back(std::make_unique<LibraryMethod>(name, handle, false));
            methods.push_back(std::make_unique<LibraryMethod>(name + ", quick look", handle, true));
        }
    }
    return methods;
}

std::vector<std::unique_ptr<TensionMethod>> other_library_methods() {
    std::vector<std::unique_ptr<TensionMethod>> methods;
    for (const Library &library : {Library{"eiquadprog_plain", "eiquadprog 1.3.2, plain", false},
                                   Library{"eiquadprog_avx2", "eiquadprog 1.3.2, avx2", true},
                                   Library{"quadprog", "quadprog 0.1.14", false},
                                   Library{"qpoases", "qpOASES 3.2.2", false}}) {
        void *handle = runs_here(library) ? open_library(library) : nullptr;
        if (handle != nullptr) {
            methods.push_back(std::make_unique<LibraryMethod>(library.name, handle, false));
        }
    }
    return methods;
}

bool is_daqp(const std::string &name) {
    return name.rfind(kDaqp, 0) == 0;
}

} // namespace spidar::bench
