#pragma once

#include <godot_cpp/core/defs.hpp>

namespace godot {

enum ModuleInitializationLevel {
    MODULE_INITIALIZATION_LEVEL_CORE = GDEXTENSION_INITIALIZATION_CORE,
    MODULE_INITIALIZATION_LEVEL_SERVERS = GDEXTENSION_INITIALIZATION_SERVERS,
    MODULE_INITIALIZATION_LEVEL_SCENE = GDEXTENSION_INITIALIZATION_SCENE,
    MODULE_INITIALIZATION_LEVEL_EDITOR = GDEXTENSION_INITIALIZATION_EDITOR,
    MODULE_INITIALIZATION_LEVEL_MAX
};

class GDExtensionBinding {
public:
    using Callback = void (*)(ModuleInitializationLevel);

    // The library's entry function makes an InitObject, registers the callbacks and returns init().
    class InitObject {
    public:
        InitObject(GDExtensionInterfaceGetProcAddress get_proc_address,
                   GDExtensionClassLibraryPtr library, GDExtensionInitialization *initialization);

        void register_initializer(Callback callback) const;
        void register_terminator(Callback callback) const;
        void set_minimum_library_initialization_level(ModuleInitializationLevel level) const;

        // Returns false and prints the reason when this Godot cannot run the library. Godot then
        // continues without the library.
        GDExtensionBool init() const;

    private:
        GDExtensionInitialization *initialization_;
        bool usable_;
    };
};

} // namespace godot
