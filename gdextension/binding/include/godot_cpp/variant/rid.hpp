#pragma once

#include <godot_cpp/core/defs.hpp>

namespace godot {

// The name of something that a server owns. Equal names are the same thing, until that is freed.
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
