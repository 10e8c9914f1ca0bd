// Start and end of the library: the engine's functions, the version check, the levels.

#include <godot_cpp/core/version.hpp>
#include <godot_cpp/godot.hpp>
#include <godot_cpp/internal/class_record.hpp>
#include <godot_cpp/internal/engine_classes.hpp>
#include <godot_cpp/internal/interface.hpp>

#include <cstdio>
#include <deque>
#include <mutex>
#include <string>

namespace godot::internal {

Interface api;
GDExtensionClassLibraryPtr library = nullptr;
Lifecycle lifecycles[GDEXTENSION_VARIANT_TYPE_VARIANT_MAX];

namespace {

// The common start of GDExtensionGodotVersion and GDExtensionGodotVersion2, with room for the rest
// of both: a header of Godot 4.4 knows the first only.
struct RunningVersion {
    uint32_t major = 0;
    uint32_t minor = 0;
    uint32_t patch = 0;
    uint64_t rest[16] = {};
};

void refuse(const std::string &reason) {
    const std::string text = "The extension does not start: " + reason;
    if (api.print_error != nullptr) {
        api.print_error(text.c_str(), "load_interface", __FILE__, __LINE__, 0);
    } else {
        std::fprintf(stderr, "ERROR: %s\n", text.c_str());
    }
}

bool version_serves(GDExtensionInterfaceGetProcAddress get_proc_address) {
    GDExtensionInterfaceFunctionPtr found = get_proc_address("get_godot_version2");
    if (found == nullptr) {
        found = get_proc_address("get_godot_version");
    }
    if (found == nullptr) {
        refuse("this Godot does not tell its version. Use Godot 4.4 or later.");
        return false;
    }
    RunningVersion running;
    reinterpret_cast<void (*)(RunningVersion *)>(found)(&running);
    // As godot-cpp compares, and as the add-on's manifest says to the engine.
    if (running.major == GODOT_VERSION_MAJOR &&
        std::pair(running.minor, running.patch) >=
            std::pair<uint32_t, uint32_t>(GODOT_VERSION_MINOR, GODOT_VERSION_PATCH)) {
        return true;
    }
    const std::string needed = std::to_string(GODOT_VERSION_MAJOR) + "." +
                               std::to_string(GODOT_VERSION_MINOR) + "." +
                               std::to_string(GODOT_VERSION_PATCH);
    refuse("it was built for the API of Godot " + needed + ", this is Godot " +
           std::to_string(running.major) + "." + std::to_string(running.minor) + "." +
           std::to_string(running.patch) + ". Use Godot " + needed +
           " or a later 4.x, or build the extension with this Godot.");
    return false;
}

// For the types that this binding offers; the others stay null, and nothing reaches them.
void load_lifecycle(GDExtensionVariantType type) {
    Lifecycle &lifecycle = lifecycles[type];
    lifecycle.construct = api.variant_get_ptr_constructor(type, 0);
    lifecycle.copy = api.variant_get_ptr_constructor(type, 1);
    lifecycle.destroy = api.variant_get_ptr_destructor(type);
    lifecycle.to_variant = api.get_variant_from_type_constructor(type);
    lifecycle.from_variant = api.get_variant_to_type_constructor(type);
}

struct PersistentName {
    explicit PersistentName(const char *literal) : text(literal) { intern(); }
    void intern() { api.string_name_new_with_latin1_chars(&name, text, 0); }
    const char *text;
    alignas(8) std::byte name[8] = {};
};

std::mutex &names_mutex() {
    static std::mutex mutex;
    return mutex;
}

// Never destroyed: what it held is given back by release_persistent_names() while the engine is
// still there, not when the library's static objects end.
std::deque<PersistentName> &names() {
    static auto *all = new std::deque<PersistentName>();
    return *all;
}

} // namespace

bool load_interface(GDExtensionInterfaceGetProcAddress get_proc_address,
                    GDExtensionClassLibraryPtr class_library) {
    if (get_proc_address == nullptr || class_library == nullptr) {
        refuse("its entry function was called without the engine's interface.");
        return false;
    }
    std::string missing;
#define GODOT_BINDING_LOAD(name, type)                                                             \
    api.name = reinterpret_cast<GDExtensionInterface##type>(get_proc_address(#name));              \
    if (api.name == nullptr) {                                                                     \
        missing += missing.empty() ? #name : ", " #name;                                           \
    }
    GODOT_BINDING_FUNCTIONS(GODOT_BINDING_LOAD)
#undef GODOT_BINDING_LOAD
    // The version first: an older Godot is why functions are missing, and says what to do.
    if (!version_serves(get_proc_address)) {
        return false;
    }
    if (!missing.empty()) {
        refuse("this Godot lacks the interface functions " + missing +
               ". Use an official build of Godot 4.4 or later.");
        return false;
    }
    library = class_library;
    for (int type = GDEXTENSION_VARIANT_TYPE_BOOL; type < GDEXTENSION_VARIANT_TYPE_VARIANT_MAX;
         ++type) {
        load_lifecycle(static_cast<GDExtensionVariantType>(type));
    }
    const std::lock_guard lock(names_mutex());
    for (PersistentName &name : names()) {
        name.intern();
    }
    return true;
}

const StringName &persistent_name(const char *text) {
    const std::lock_guard lock(names_mutex());
    return reinterpret_cast<const StringName &>(names().emplace_back(text).name);
}

void release_persistent_names() {
    const std::lock_guard lock(names_mutex());
    const GDExtensionPtrDestructor destroy =
        lifecycles[GDEXTENSION_VARIANT_TYPE_STRING_NAME].destroy;
    for (PersistentName &name : names()) {
        destroy(&name.name);
        std::fill(std::begin(name.name), std::end(name.name), std::byte(0));
    }
}

void report_error(const char *function, const char *file, int line, const char *condition,
                  const char *message) {
    if (*message == '\0') {
        api.print_error(condition, function, file, line, 0);
    } else {
        api.print_error_with_message(condition, message, function, file, line, 0);
    }
}

void report_warning(const char *function, const char *file, int line, const char *message) {
    api.print_warning(message, function, file, line, 0);
}

} // namespace godot::internal

namespace godot {

namespace {

GDExtensionBinding::Callback initializer = nullptr;
GDExtensionBinding::Callback terminator = nullptr;
GDExtensionInitializationLevel lowest_level = GDEXTENSION_INITIALIZATION_SCENE;

void initialize(void *, GDExtensionInitializationLevel level) {
    internal::set_registration_level(level);
    if (initializer != nullptr) {
        initializer(static_cast<ModuleInitializationLevel>(level));
    }
}

void deinitialize(void *, GDExtensionInitializationLevel level) {
    if (terminator != nullptr) {
        terminator(static_cast<ModuleInitializationLevel>(level));
    }
    internal::unregister_classes(level);
    if (level == lowest_level) {
        internal::release_wrappers();
        internal::release_persistent_names();
    }
}

} // namespace

GDExtensionBinding::InitObject::InitObject(GDExtensionInterfaceGetProcAddress get_proc_address,
                                           GDExtensionClassLibraryPtr library,
                                           GDExtensionInitialization *initialization)
    : initialization_(initialization),
      usable_(initialization != nullptr && internal::load_interface(get_proc_address, library)) {
    initializer = nullptr;
    terminator = nullptr;
    lowest_level = GDEXTENSION_INITIALIZATION_SCENE;
}

void GDExtensionBinding::InitObject::register_initializer(Callback callback) const {
    initializer = callback;
}

void GDExtensionBinding::InitObject::register_terminator(Callback callback) const {
    terminator = callback;
}

void GDExtensionBinding::InitObject::set_minimum_library_initialization_level(
    ModuleInitializationLevel level) const {
    lowest_level = static_cast<GDExtensionInitializationLevel>(level);
}

GDExtensionBool GDExtensionBinding::InitObject::init() const {
    if (!usable_) {
        return 0;
    }
    initialization_->minimum_initialization_level = lowest_level;
    initialization_->userdata = nullptr;
    initialization_->initialize = &initialize;
    initialization_->deinitialize = &deinitialize;
    return 1;
}

} // namespace godot
