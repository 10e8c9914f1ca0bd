// What the tension solver is compared with, each behind one interface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/tension/tension_solver.h"

namespace spidar::bench {

class TensionMethod {
public:
    explicit TensionMethod(std::string name) : name_(std::move(name)) {}
    virtual ~TensionMethod() = default;
    TensionMethod(const TensionMethod &) = delete;
    TensionMethod &operator=(const TensionMethod &) = delete;

    [[nodiscard]] const std::string &name() const { return name_; }
    // The timed call. warm: from what the last call ended with. False: the method gave up.
    virtual bool solve(const TensionProblem &problem, bool warm, StringArray &tensions_n) = 0;

private:
    std::string name_;
};

// Ours in every build this processor runs, the safe search alone, the libraries that are there, and the simple ones.
[[nodiscard]] std::vector<std::unique_ptr<TensionMethod>> tension_methods();

} // namespace spidar::bench
