#include "probe.hpp"
#ifndef PROBE_WITHOUT_FAULTS
#include "probe_faults.hpp"
#endif

#include <godot_cpp/godot.hpp>

using namespace godot;

namespace {

void initialize(ModuleInitializationLevel level) {
    if (level != MODULE_INITIALIZATION_LEVEL_SCENE) {
        return;
    }
    GDREGISTER_CLASS(probe::ProbeConfig);
    GDREGISTER_CLASS(probe::ProbeCounter);
    GDREGISTER_CLASS(probe::Probe);
    GDREGISTER_CLASS(probe::DerivedProbe);
#ifndef PROBE_WITHOUT_FAULTS
    GDREGISTER_CLASS(probe::ProbeFaults);
#endif
}

} // namespace

extern "C" GDExtensionBool GDE_EXPORT
binding_probe_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                   GDExtensionClassLibraryPtr library, GDExtensionInitialization *initialization) {
    const GDExtensionBinding::InitObject init(get_proc_address, library, initialization);
    init.register_initializer(initialize);
    init.set_minimum_library_initialization_level(MODULE_INITIALIZATION_LEVEL_SCENE);
    return init.init();
}
