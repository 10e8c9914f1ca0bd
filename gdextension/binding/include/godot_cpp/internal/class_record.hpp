#pragma once

// Not part of the godot-cpp API: what is kept of a registered class and its methods.

#include <godot_cpp/core/property_info.hpp>

#include <memory>

namespace godot {

class Wrapped;

namespace internal {

struct MethodRecord {
    virtual ~MethodRecord() = default;

    StringName name;
    std::vector<StringName> argument_names;
    std::vector<Variant> defaults; // of the last arguments
    bool has_return = false;
    PropertyInfo return_info;
    GDExtensionClassMethodArgumentMetadata return_metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    std::vector<PropertyInfo> arguments;
    std::vector<Variant::Type> insisted_types; // of the arguments; nil: the method checks it itself
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

// All that registration needs to know of a class, so that one plain function can do it.
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

// Prints why when the class cannot be registered.
void register_class(std::unique_ptr<ClassRecord> record);
const ClassRecord *find_class(const StringName &name);
// The class's own virtual method for the engine's; null when it has none, or when the engine's has
// other arguments now (which is printed once).
GDExtensionClassCallVirtual find_virtual(const ClassRecord &record, const StringName &name,
                                         uint32_t hash);
// Registers; prints why when it cannot.
void register_method(const StringName &class_name, std::unique_ptr<MethodRecord> method);
void set_registration_level(GDExtensionInitializationLevel level);
// Unregisters the classes of that level, the newest first.
void unregister_classes(GDExtensionInitializationLevel level);

// The engine's half of a new object of an extension class, and ours around it.
Wrapped *create_object(const ClassRecord &record, bool notify);

} // namespace internal
} // namespace godot
