// Engine methods looked up, objects made, wrapped and ended, methods as Callables.

#include <godot_cpp/core/memory.hpp>
#include <godot_cpp/internal/engine_classes.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>

#include <cstring>
#include <mutex>
#include <string>
#include <unordered_set>

namespace godot {

namespace internal {

namespace {

void report_missing(const std::string &what, int64_t hash) {
    report_error(
        __func__, __FILE__, __LINE__,
        (what + " (hash " + std::to_string(hash) +
         ") is not in this Godot: calls of it do nothing and answer a default value. Build "
         "the extension with the API of this Godot, or use a Godot that has it.")
            .c_str(),
        "");
}

struct Expected {
    const ClassRecord *record = nullptr;
    GodotObject *owner = nullptr;
};

// What the next Wrapped constructor on this thread is to stand for. Trivial on purpose: a
// thread_local with a destructor would keep the library from being unloaded.
thread_local Expected expected;

// The engine keeps our half of an extension object by the instance itself: nothing to free here.
const GDExtensionInstanceBindingCallbacks kOwnBinding = {
    [](void *, void *) -> void * { return nullptr; }, [](void *, void *, void *) {},
    [](void *, void *, GDExtensionBool) -> GDExtensionBool { return 1; }};

std::mutex wrappers_mutex;
std::unordered_set<GodotObject *> wrapped_objects; // the engine's own, not those of our classes
std::vector<Singleton *> singletons;

void remember_wrapper(GodotObject *owner) {
    const std::lock_guard lock(wrappers_mutex);
    wrapped_objects.insert(owner);
}

void end_wrapper(GodotObject *owner, Wrapped *wrapper) {
    {
        const std::lock_guard lock(wrappers_mutex);
        wrapped_objects.erase(owner);
    }
    Access::destroy(wrapper);
}

Wrapped *make_wrapper(GodotObject *owner) {
    for (std::size_t i = 0; i < engine_class_count; ++i) {
        EngineClass &candidate = engine_classes[i]; // derived classes first
        if (candidate.tag == nullptr) {
            candidate.tag = api.classdb_get_class_tag(StringName(candidate.name)._native_ptr());
        }
        if (candidate.tag != nullptr && api.object_cast_to(owner, candidate.tag) != nullptr) {
            remember_wrapper(owner);
            return candidate.wrap(owner);
        }
    }
    return nullptr;
}

const GDExtensionInstanceBindingCallbacks kWrapperBinding = {
    [](void *, void *owner) -> void * { return make_wrapper(owner); },
    [](void *, void *owner, void *wrapper) { end_wrapper(owner, static_cast<Wrapped *>(wrapper)); },
    [](void *, void *, GDExtensionBool) -> GDExtensionBool { return 1; }};

} // namespace

EngineMethod::EngineMethod(const char *class_name, const char *method, int64_t hash)
    : bind(api.classdb_get_method_bind(StringName(class_name)._native_ptr(),
                                       StringName(method)._native_ptr(), hash)) {
    if (bind == nullptr) {
        report_missing(std::string(class_name) + "." + method, hash);
    }
}

BuiltinMethod::BuiltinMethod(GDExtensionVariantType type, const char *method, int64_t hash)
    : call(api.variant_get_ptr_builtin_method(type, StringName(method)._native_ptr(), hash)) {
    if (call == nullptr) {
        const String type_name = Variant::get_type_name(static_cast<Variant::Type>(type));
        report_missing(std::string(type_name.utf8().get_data()) + "." + method, hash);
    }
}

UtilityFunction::UtilityFunction(const char *name, int64_t hash)
    : call(api.variant_get_ptr_utility_function(StringName(name)._native_ptr(), hash)) {
    if (call == nullptr) {
        report_missing(name, hash);
    }
}

void report_no_owner() {
    report_error(__func__, __FILE__, __LINE__,
                 "An engine method was called on an object that the engine did not make: make it "
                 "with memnew(T) or Ref<T>::instantiate().",
                 "");
}

void report_call_error(const GDExtensionCallError &error) {
    const std::string text = "A call of an engine method failed: error " +
                             std::to_string(static_cast<int>(error.error)) + ", argument " +
                             std::to_string(error.argument) + ".";
    report_error(__func__, __FILE__, __LINE__, text.c_str(), "");
}

void Access::expect(const ClassRecord &record, GodotObject *owner) {
    expected = {&record, owner};
}

Wrapped *wrap(GodotObject *owner) {
    return owner == nullptr ? nullptr
                            : static_cast<Wrapped *>(api.object_get_instance_binding(
                                  owner, library, &kWrapperBinding));
}

Singleton::Singleton(const char *name) : name_(name) {
    const std::lock_guard lock(wrappers_mutex);
    singletons.push_back(this);
}

Wrapped *Singleton::look_up() const {
    return wrap(api.global_get_singleton(StringName(name_)._native_ptr()));
}

void release_wrappers() {
    std::unordered_set<GodotObject *> left;
    {
        const std::lock_guard lock(wrappers_mutex);
        left.swap(wrapped_objects);
        for (Singleton *singleton : singletons) {
            singleton->forget();
        }
    }
    // Without the lock: the engine calls end_wrapper() for each.
    for (GodotObject *owner : left) {
        api.object_free_instance_binding(owner, library);
    }
}

GodotObject *construct_engine_object(const StringName &class_name) {
    return api.classdb_construct_object2(class_name._native_ptr());
}

void send_postinitialize(Wrapped *object) {
    if (object != nullptr) {
        static_cast<Object *>(object)->notification(Object::NOTIFICATION_POSTINITIALIZE);
    }
}

void destroy_object(Wrapped *object) {
    if (object != nullptr) {
        api.object_destroy(object->_owner);
    }
}

Wrapped *create_object(const ClassRecord &record, bool notify) {
    if (record.construct == nullptr) {
        return nullptr;
    }
    GodotObject *owner = construct_engine_object(record.engine_base);
    if (owner == nullptr) {
        return nullptr;
    }
    Wrapped *made = record.construct(record, owner);
    if (notify) {
        send_postinitialize(made);
    }
    return made;
}

// What a Callable of callable_mp keeps.
struct BoundCallable {
    std::unique_ptr<MethodRecord> record;
    Wrapped *instance;
    GDObjectInstanceID object;
    const void *identity;
    std::size_t identity_size;
};

namespace {

const BoundCallable &bound(void *userdata) {
    return *static_cast<const BoundCallable *>(userdata);
}

void call_bound(void *userdata, const GDExtensionConstVariantPtr *arguments, GDExtensionInt count,
                GDExtensionVariantPtr result, GDExtensionCallError *error) {
    const BoundCallable &self = bound(userdata);
    if (api.object_get_instance_from_id(self.object) == nullptr) {
        *error = {GDEXTENSION_CALL_ERROR_INSTANCE_IS_NULL, 0, 0};
        return;
    }
    *error = {GDEXTENSION_CALL_OK, 0, 0};
    self.record->call(self.record.get(), self.instance, arguments, count, result, error);
}

GDExtensionBool equal_bound(void *a, void *b) {
    const BoundCallable &x = bound(a);
    const BoundCallable &y = bound(b);
    return x.object == y.object && x.record->call == y.record->call &&
                   x.identity_size == y.identity_size &&
                   std::memcmp(x.identity, y.identity, x.identity_size) == 0
               ? 1
               : 0;
}

// Of the object only: equal Callables get equal hashes, and few share an object.
uint32_t hash_bound(void *userdata) {
    const GDObjectInstanceID id = bound(userdata).object;
    return static_cast<uint32_t>(id ^ (id >> 32U));
}

} // namespace
} // namespace internal

Callable make_bound_callable(GDExtensionCallableCustomInfo2 &info) {
    Callable made;
    internal::api.callable_custom_create2(made._native_ptr(), &info);
    return made;
}

namespace internal {

Callable make_callable(const Object *object, Wrapped *instance,
                       std::unique_ptr<MethodRecord> record, const void *identity,
                       std::size_t identity_size) {
    const GDObjectInstanceID id = api.object_get_instance_id(object->_owner);
    GDExtensionCallableCustomInfo2 info = {};
    info.callable_userdata =
        new BoundCallable{std::move(record), instance, id, identity, identity_size};
    info.token = library;
    info.object_id = id;
    info.call_func = &call_bound;
    info.free_func = [](void *userdata) { delete static_cast<BoundCallable *>(userdata); };
    info.hash_func = &hash_bound;
    info.equal_func = &equal_bound;
    info.get_argument_count_func = [](void *userdata, GDExtensionBool *valid) -> GDExtensionInt {
        *valid = 1;
        return static_cast<GDExtensionInt>(bound(userdata).record->arguments.size());
    };
    return make_bound_callable(info);
}

} // namespace internal

Wrapped::Wrapped() {
    const internal::Expected mine = std::exchange(internal::expected, {});
    if (mine.record == nullptr) {
        internal::report_no_owner();
        return;
    }
    _owner = mine.owner;
    internal::api.object_set_instance(_owner, mine.record->name._native_ptr(), this);
    internal::api.object_set_instance_binding(_owner, internal::library, this,
                                              &internal::kOwnBinding);
}

} // namespace godot
