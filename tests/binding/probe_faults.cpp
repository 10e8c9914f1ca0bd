#include "probe_faults.hpp"

using namespace godot;

namespace probe {

void ProbeFaults::_bind_methods() {
    ClassDB::bind_method(D_METHOD("call_missing_method"), &ProbeFaults::call_missing_method);
    ClassDB::bind_method(D_METHOD("use_stack_object"), &ProbeFaults::use_stack_object);
    ClassDB::bind_method(D_METHOD("ask_changed_virtual"), &ProbeFaults::ask_changed_virtual);
    ClassDB::bind_method(D_METHOD("warnings_of", "probe"), &ProbeFaults::warnings_of);
}

int64_t ProbeFaults::call_missing_method() {
    // A method whose hash no Godot has: what a changed engine method looks like.
    static const internal::EngineMethod method("Node3D", "get_phantom", 12345);
    static const internal::BuiltinMethod builtin(GDEXTENSION_VARIANT_TYPE_ARRAY, "phantom_sort",
                                                 12345);
    const Vector3 vector = internal::call_engine<Vector3>(method, _owner, int64_t{3});
    const Array array;
    const int64_t count = internal::call_builtin<int64_t>(builtin, array._native_ptr());
    const Variant nothing = internal::call_engine_vararg(method, _owner, 1, 2);
    return vector == Vector3() && count == 0 && nothing == Variant() ? 0 : 1;
}

int64_t ProbeFaults::use_stack_object() const {
    const ProbeConfig config; // not made by memnew: prints so, and stays usable in C++
    const String path = config.get_path();
    return config.get_rate_hz() == 1000.0 && path.is_empty() ? 0 : 1;
}

int64_t ProbeFaults::ask_changed_virtual() const {
    internal::ClassRecord record;
    const auto call = [](GDExtensionClassInstancePtr, const GDExtensionConstTypePtr *,
                         GDExtensionTypePtr) {};
    record.virtuals.push_back({StringName("_changed"), 1, call});
    record.virtuals.push_back({StringName("_same"), 1, call});
    int64_t answered = 0;
    for (int i = 0; i < 3; ++i) {
        answered += internal::find_virtual(record, StringName("_changed"), 2) != nullptr ? 1 : 0;
    }
    const bool others_stay = internal::find_virtual(record, StringName("_same"), 1) != nullptr &&
                             internal::find_virtual(record, StringName("_other"), 1) == nullptr;
    return others_stay ? answered : -1;
}

PackedStringArray ProbeFaults::warnings_of(Probe *probe) const {
    ERR_FAIL_NULL_V(probe, PackedStringArray());
    const internal::ClassRecord *record = internal::find_class(StringName("Probe"));
    PackedStringArray warnings;
    for (const internal::VirtualEntry &entry : record->virtuals) {
        if (entry.name == StringName("_get_configuration_warnings")) {
            entry.call(static_cast<Wrapped *>(probe), nullptr, &warnings);
            return warnings;
        }
    }
    warnings.push_back("no such virtual method");
    return warnings;
}

} // namespace probe
