#pragma once

// What real godot-cpp answers with a crash and this binding with a message, and what only the editor
// would call. These use the binding's inside on purpose, as no allowed name reaches them: with a real
// godot-cpp, build with PROBE_WITHOUT_FAULTS and leave probe_faults.cpp out.

#include "probe.hpp"

namespace probe {

class ProbeFaults : public godot::RefCounted {
    GDCLASS(ProbeFaults, godot::RefCounted)

public:
    int64_t call_missing_method();
    int64_t use_stack_object() const;
    // How many of three requests for a virtual method with another hash were answered.
    int64_t ask_changed_virtual() const;
    godot::PackedStringArray warnings_of(Probe *probe) const;

protected:
    static void _bind_methods();
};

} // namespace probe
