// What real godot-cpp answers with a crash and this binding with a message: these use the binding's
// inside on purpose, as no allowed name reaches them.

#include "probe.hpp"

using namespace godot;

namespace probe {

int64_t Probe::call_missing_method() {
    // A method whose hash no Godot has: what a changed engine method looks like.
    static const internal::EngineMethod method("Node3D", "get_phantom", 12345);
    const internal::BuiltinMethod builtin(GDEXTENSION_VARIANT_TYPE_ARRAY, "phantom_sort", 12345);
    const Vector3 vector = internal::call_engine<Vector3>(method, _owner, int64_t{3});
    const Array array;
    const int64_t count = internal::call_builtin<int64_t>(builtin, array._native_ptr());
    const Variant nothing = internal::call_engine_vararg(method, _owner, 1, 2);
    return vector == Vector3() && count == 0 && nothing == Variant() ? 0 : 1;
}

int64_t Probe::stack_object_calls() const {
    const ProbeConfig config; // not made by memnew: prints so, and stays usable in C++
    const String path = config.get_path();
    return config.get_rate_hz() == 1000.0 && path.is_empty() ? 0 : 1;
}

} // namespace probe
