// Registration of classes, methods, properties, signals and constants.

#include <godot_cpp/core/class_db.hpp>

#include <algorithm>
#include <mutex>
#include <set>
#include <string>

namespace godot {

namespace internal {

namespace {

// In order of registration, so parents stand before their children.
std::vector<std::unique_ptr<ClassRecord>> classes;
GDExtensionInitializationLevel current_level = GDEXTENSION_INITIALIZATION_SCENE;

std::string text_of(const StringName &name) {
    return String(name).utf8().get_data();
}

void complain(const std::string &text) {
    report_error(__func__, __FILE__, __LINE__, text.c_str(), "");
}

GDExtensionPropertyInfo described(const PropertyInfo &info, const StringName &name) {
    return {static_cast<GDExtensionVariantType>(info.type),
            name._native_ptr(),
            info.class_name._native_ptr(),
            info.hint,
            info.hint_string._native_ptr(),
            info.usage};
}

GDExtensionPropertyInfo described(const PropertyInfo &info) {
    return described(info, info.name);
}

const MethodRecord *find_method(const StringName &class_name, const StringName &method) {
    // Bounded by the number of classes: each step goes to an earlier one.
    for (const ClassRecord *record = find_class(class_name); record != nullptr;
         record = find_class(record->parent)) {
        for (const auto &candidate : record->methods) {
            if (candidate->name == method) {
                return candidate.get();
            }
        }
    }
    return nullptr;
}

GDExtensionObjectPtr create_instance(void *userdata, GDExtensionBool notify) {
    const Wrapped *made = create_object(*static_cast<const ClassRecord *>(userdata), notify != 0);
    return made == nullptr ? nullptr : made->_owner;
}

void free_instance(void *, GDExtensionClassInstancePtr instance) {
    Access::destroy(static_cast<Wrapped *>(instance));
}

GDExtensionClassCallVirtual get_virtual(void *userdata, GDExtensionConstStringNamePtr name,
                                        uint32_t hash) {
    return find_virtual(*static_cast<const ClassRecord *>(userdata),
                        *static_cast<const StringName *>(name), hash);
}

// Any thread of the engine may be the first to ask for a virtual method.
bool first_complaint_of(const std::string &method) {
    static std::mutex mutex;
    static std::set<std::string> told;
    const std::lock_guard lock(mutex);
    return told.insert(method).second;
}

} // namespace

const ClassRecord *find_class(const StringName &name) {
    const auto found = std::find_if(classes.begin(), classes.end(),
                                    [&](const auto &record) { return record->name == name; });
    return found == classes.end() ? nullptr : found->get();
}

GDExtensionClassCallVirtual find_virtual(const ClassRecord &record, const StringName &wanted,
                                         uint32_t hash) {
    for (const VirtualEntry &entry : record.virtuals) {
        if (entry.name != wanted) {
            continue;
        }
        if (entry.hash == hash) {
            return entry.call;
        }
        if (first_complaint_of(text_of(record.name) + "." + text_of(wanted))) {
            complain("The virtual method " + text_of(wanted) +
                     " has other arguments in this Godot than in the one that the extension was "
                     "built with: it is not called. Build the extension with the API of this "
                     "Godot.");
        }
        return nullptr;
    }
    return nullptr;
}

void set_registration_level(GDExtensionInitializationLevel level) {
    current_level = level;
}

void register_class(std::unique_ptr<ClassRecord> record) {
    if (find_class(record->name) != nullptr) {
        complain("The class " + text_of(record->name) + " is registered already.");
        return;
    }
    if (record->parent != record->engine_base && find_class(record->parent) == nullptr) {
        complain("The class " + text_of(record->name) + " is registered before its parent " +
                 text_of(record->parent) + ": register the parent first.");
        return;
    }
    record->level = current_level;
    GDExtensionClassCreationInfo4 info = {};
    info.is_abstract = record->is_abstract || record->construct == nullptr ? 1 : 0;
    info.is_exposed = 1;
    info.set_func = record->set;
    info.get_func = record->get;
    info.validate_property_func = record->validate_property;
    info.notification_func = record->notification;
    info.to_string_func = record->to_string;
    info.create_instance_func = &create_instance;
    info.free_instance_func = &free_instance;
    info.get_virtual_func = &get_virtual;
    info.class_userdata = record.get();
    api.classdb_register_extension_class4(library, record->name._native_ptr(),
                                          record->parent._native_ptr(), &info);
    classes.emplace_back(std::move(record))->bind_methods();
}

void unregister_classes(GDExtensionInitializationLevel level) {
    for (std::size_t i = classes.size(); i-- > 0;) {
        if (classes[i]->level == level) {
            api.classdb_unregister_extension_class(library, classes[i]->name._native_ptr());
            classes.erase(classes.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
}

void register_method(const StringName &class_name, std::unique_ptr<MethodRecord> method) {
    const auto owner = std::find_if(classes.begin(), classes.end(),
                                    [&](const auto &record) { return record->name == class_name; });
    const std::string full_name = text_of(class_name) + "." + text_of(method->name);
    if (owner == classes.end()) {
        complain("The method " + full_name + " is bound to a class that is not registered.");
        return;
    }
    const auto &known = (*owner)->methods;
    if (std::any_of(known.begin(), known.end(),
                    [&](const auto &other) { return other->name == method->name; })) {
        complain("The method " + full_name + " is bound already.");
        return;
    }
    if (method->argument_names.size() > method->arguments.size()) {
        complain("The method " + full_name + " has more argument names than arguments.");
        return;
    }
    // An argument without a name in D_METHOD is known to scripts by its place.
    for (std::size_t i = method->argument_names.size(); i < method->arguments.size(); ++i) {
        method->argument_names.emplace_back(("arg" + std::to_string(i)).c_str());
    }
    std::vector<GDExtensionPropertyInfo> arguments;
    for (std::size_t i = 0; i < method->arguments.size(); ++i) {
        arguments.push_back(described(method->arguments[i], method->argument_names[i]));
    }
    std::vector<GDExtensionVariantPtr> defaults;
    for (const Variant &value : method->defaults) {
        defaults.push_back(value._native_ptr());
    }
    GDExtensionPropertyInfo return_info = described(method->return_info);
    GDExtensionClassMethodInfo info = {};
    info.name = method->name._native_ptr();
    info.method_userdata = method.get();
    info.call_func = method->call;
    info.ptrcall_func = method->pointer_call;
    info.method_flags = method->flags;
    info.has_return_value = method->has_return ? 1 : 0;
    info.return_value_info = &return_info;
    info.return_value_metadata = method->return_metadata;
    info.argument_count = static_cast<uint32_t>(arguments.size());
    info.arguments_info = arguments.data();
    info.arguments_metadata = method->argument_metadata.data();
    info.default_argument_count = static_cast<uint32_t>(defaults.size());
    info.default_arguments = defaults.data();
    api.classdb_register_extension_class_method(library, class_name._native_ptr(), &info);
    (*owner)->methods.push_back(std::move(method));
}

bool arrange_arguments(const MethodRecord &method, const GDExtensionConstVariantPtr *given,
                       GDExtensionInt count, const Variant **arranged,
                       GDExtensionCallError &error) {
    const auto total = static_cast<GDExtensionInt>(method.arguments.size());
    const auto first_default = total - static_cast<GDExtensionInt>(method.defaults.size());
    if (count > total) {
        error = {GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS, 0, static_cast<int32_t>(total)};
        return false;
    }
    if (count < first_default) {
        error = {GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS, 0, static_cast<int32_t>(first_default)};
        return false;
    }
    for (GDExtensionInt i = 0; i < total; ++i) {
        const auto place = static_cast<std::size_t>(i);
        arranged[i] = i < count ? static_cast<const Variant *>(given[i])
                                : &method.defaults[static_cast<std::size_t>(i - first_default)];
        const Variant::Type wanted = method.insisted_types[place];
        const Variant::Type have = arranged[i]->get_type();
        if (wanted != Variant::NIL && have != wanted &&
            !Variant::can_convert_strict(have, wanted)) {
            error = {GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT, static_cast<int32_t>(i),
                     static_cast<int32_t>(wanted)};
            return false;
        }
    }
    error = {GDEXTENSION_CALL_OK, 0, 0};
    return true;
}

StringName enum_class_name(const char *qualified_name) {
    std::string text = qualified_name;
    // The last two parts: Class::Enum, whatever namespaces stand before.
    const std::size_t last = text.rfind("::");
    if (last == std::string::npos) {
        return text.c_str();
    }
    const std::size_t before = last == 0 ? std::string::npos : text.rfind("::", last - 1);
    const std::size_t start = before == std::string::npos ? 0 : before + 2;
    return (text.substr(start, last - start) + "." + text.substr(last + 2)).c_str();
}

StringName enum_short_name(const StringName &class_and_enum) {
    const std::string text = text_of(class_and_enum);
    return text.substr(text.rfind('.') + 1).c_str(); // npos + 1 is 0
}

} // namespace internal

void ClassDB::add_property(const StringName &class_name, const PropertyInfo &info,
                           const StringName &setter, const StringName &getter) {
    const auto fits = [&](const StringName &name, std::size_t arguments, const char *role) {
        if (name == StringName()) {
            return true; // a property may lack a setter
        }
        const internal::MethodRecord *method = internal::find_method(class_name, name);
        if (method != nullptr && method->arguments.size() == arguments) {
            return true;
        }
        internal::complain("The property " + internal::text_of(class_name) + "." +
                           internal::text_of(info.name) + " needs a bound " + role + " " +
                           internal::text_of(name) + " with " + std::to_string(arguments) +
                           " arguments: bind it before the property.");
        return false;
    };
    if (fits(setter, 1, "setter") && fits(getter, 0, "getter")) {
        const GDExtensionPropertyInfo property = internal::described(info);
        internal::api.classdb_register_extension_class_property(
            internal::library, class_name._native_ptr(), &property, setter._native_ptr(),
            getter._native_ptr());
    }
}

void ClassDB::add_property_group(const StringName &class_name, const String &name,
                                 const String &prefix) {
    internal::api.classdb_register_extension_class_property_group(
        internal::library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_property_subgroup(const StringName &class_name, const String &name,
                                    const String &prefix) {
    internal::api.classdb_register_extension_class_property_subgroup(
        internal::library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_signal(const StringName &class_name, const MethodInfo &signal) {
    std::vector<GDExtensionPropertyInfo> arguments;
    for (const PropertyInfo &argument : signal.arguments) {
        arguments.push_back(internal::described(argument));
    }
    internal::api.classdb_register_extension_class_signal(
        internal::library, class_name._native_ptr(), signal.name._native_ptr(), arguments.data(),
        static_cast<GDExtensionInt>(arguments.size()));
}

void ClassDB::bind_integer_constant(const StringName &class_name, const StringName &enum_name,
                                    const StringName &constant, int64_t value) {
    internal::api.classdb_register_extension_class_integer_constant(
        internal::library, class_name._native_ptr(), enum_name._native_ptr(),
        constant._native_ptr(), value, 0);
}

} // namespace godot
