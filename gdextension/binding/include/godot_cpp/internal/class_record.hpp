#pragma once

// Not part of the godot-cpp API: the data of registered classes and their methods.

#include <godot_cpp/core/property_info.hpp>

#include <memory>

namespace godot {

class Wrapped;

namespace internal {

struct MethodRecord {
    virtual ~MethodRecord() = default;

    StringName name;
    std::vector<StringName> argument_names;
    std::vector<Variant> defaults; // default values of the last arguments
    bool has_return = false;
    PropertyInfo return_info;
    GDExtensionClassMethodArgumentMetadata return_metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    std::vector<PropertyInfo> arguments;
    std::vector<Variant::Type> insisted_types; // of the arguments; NIL: the binding accepts any
    std::vector<GDExtensionClassMethodArgumentMetadata> argument_metadata;
    uint32_t flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
    GDExtensionClassMethodCall call = nullptr;
    GDExtensionClassMethodPtrCall pointer_call = nullptr;
};

struct VirtualEntry {
    StringName name;
    uint32_t hash;
    GDExtensionClassCallVirtual call;
};

// All data of a class that registration needs, so that a function that is no template can register
// it.
struct ClassRecord {
    StringName name;
    StringName parent;
    StringName engine_base;
    bool is_abstract = false;
    GDExtensionInitializationLevel level = GDEXTENSION_INITIALIZATION_SCENE;

    Wrapped *(*construct)(const ClassRecord &, GodotObject *) = nullptr;
    void (*bind_methods)() = nullptr;
    GDExtensionClassNotification2 notification = nullptr;
    GDExtensionClassSet set = nullptr;
    GDExtensionClassGet get = nullptr;
    GDExtensionClassValidateProperty validate_property = nullptr;
    GDExtensionClassToString to_string = nullptr;

    std::vector<VirtualEntry> virtuals;
    std::vector<std::unique_ptr<MethodRecord>> methods;
};

// Registers a class, or prints why it cannot.
void register_class(std::unique_ptr<ClassRecord> record);
const ClassRecord *find_class(const StringName &name);
// Returns the class's override of an engine's virtual method. Returns null when the class has none,
// or when the engine's method has other arguments than at build time (which is printed once).
GDExtensionClassCallVirtual find_virtual(const ClassRecord &record, const StringName &name,
                                         uint32_t hash);
// Registers a method of a registered class, or prints why it cannot.
void register_method(const StringName &class_name, std::unique_ptr<MethodRecord> method);
void set_registration_level(GDExtensionInitializationLevel level);
// Unregisters the classes of that level, the newest first.
void unregister_classes(GDExtensionInitializationLevel level);

// Makes an object of an extension class: the engine's object and the C++ object for it.
Wrapped *create_object(const ClassRecord &record, bool notify);

} // namespace internal
} // namespace godot
