#pragma once

#include <godot_cpp/core/defs.hpp>

namespace godot {

// Identifies a resource of one of the engine's servers, such as a body of the physics server. The
// RID is valid until the server frees the resource.
class RID {
public:
    RID() {}

    bool is_valid() const { return id_ != 0; }
    int64_t get_id() const { return static_cast<int64_t>(id_); }
    bool operator==(const RID &other) const { return id_ == other.id_; }
    bool operator!=(const RID &other) const { return id_ != other.id_; }
    bool operator<(const RID &other) const { return id_ < other.id_; }

private:
    uint64_t id_ = 0;
};

} // namespace godot
