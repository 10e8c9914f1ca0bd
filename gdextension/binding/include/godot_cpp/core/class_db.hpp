#pragma once

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/internal/method_binder.hpp>

namespace godot {

struct MethodDefinition {
    StringName name;
    std::vector<StringName> args;

    MethodDefinition(const char *p_name) : name(p_name) {}
    MethodDefinition(const char *p_name, std::vector<StringName> p_args)
        : name(p_name), args(std::move(p_args)) {}
};

// Returns a definition from the names of a method and of its arguments.
template <typename... Args>
MethodDefinition D_METHOD(const char *p_name, const Args &...args) {
    return {p_name, std::vector<StringName>{StringName(args)...}};
}

#define DEFVAL(m_value) (m_value)

class ClassDB {
public:
    ClassDB() = delete;

    // Requires a class with its GDCLASS line, whose parent is already registered.
    template <class T>
    static void register_class() {
        static_assert(!std::is_abstract_v<T>,
                      "An abstract class is registered by GDREGISTER_ABSTRACT_CLASS.");
        internal::register_class(describe<T>(false));
    }
    template <class T>
    static void register_abstract_class() {
        internal::register_class(describe<T>(true));
    }

    // defaults: DEFVAL(value) for each of the last arguments that has a default.
    template <class M, typename... Defaults>
    static void bind_method(const MethodDefinition &definition, M method,
                            const Defaults &...defaults) {
        using Class = typename internal::Member<M>::Class;
        static_assert(std::is_base_of_v<Wrapped, Class>);
        bind(Class::get_class_static(), definition, method, defaults...);
    }
    template <class M, typename... Defaults>
    static void bind_static_method(const StringName &class_name, const MethodDefinition &definition,
                                   M method, const Defaults &...defaults) {
        static_assert(std::is_void_v<typename internal::Member<M>::Class>);
        bind(class_name, definition, method, defaults...);
    }

    static void add_property(const StringName &class_name, const PropertyInfo &info,
                             const StringName &setter, const StringName &getter);
    static void add_property_group(const StringName &class_name, const String &name,
                                   const String &prefix);
    static void add_property_subgroup(const StringName &class_name, const String &name,
                                      const String &prefix);
    static void add_signal(const StringName &class_name, const MethodInfo &signal);
    static void bind_integer_constant(const StringName &class_name, const StringName &enum_name,
                                      const StringName &constant, int64_t value);

private:
    template <class T>
    static std::unique_ptr<internal::ClassRecord> describe(bool is_abstract) {
        using internal::EngineBase;
        auto record = std::make_unique<internal::ClassRecord>();
        record->name = T::get_class_static();
        record->parent = T::get_parent_class_static();
        record->engine_base = EngineBase<T>::get_class_static();
        record->is_abstract = is_abstract;
        if constexpr (!std::is_abstract_v<T>) {
            record->construct = &internal::Access::construct<T>;
        }
        internal::Hooks<T>::fill(*record);
        internal::Virtuals<EngineBase<T>>::template collect<T>(record->virtuals);
        return record;
    }

    template <class M, typename... Defaults>
    static void bind(const StringName &class_name, const MethodDefinition &definition, M method,
                     const Defaults &...defaults) {
        auto bound = std::make_unique<internal::BoundMethod<M>>(method);
        static_assert(sizeof...(Defaults) <= internal::BoundMethod<M>::kCount,
                      "More default values than arguments.");
        bound->name = definition.name;
        bound->argument_names = definition.args;
        bound->defaults = {Variant(defaults)...};
        internal::register_method(class_name, std::move(bound));
    }
};

namespace internal {
// Returns "Mode" for "Probe.Mode".
StringName enum_short_name(const StringName &class_and_enum);
} // namespace internal

} // namespace godot

// Called in _bind_methods(), after the methods that they name are bound.
#define ADD_PROPERTY(m_property, m_setter, m_getter)                                               \
    ::godot::ClassDB::add_property(get_class_static(), m_property, m_setter, m_getter)
#define ADD_GROUP(m_name, m_prefix)                                                                \
    ::godot::ClassDB::add_property_group(get_class_static(), m_name, m_prefix)
#define ADD_SUBGROUP(m_name, m_prefix)                                                             \
    ::godot::ClassDB::add_property_subgroup(get_class_static(), m_name, m_prefix)
#define ADD_SIGNAL(m_signal) ::godot::ClassDB::add_signal(get_class_static(), m_signal)
#define BIND_CONSTANT(m_constant)                                                                  \
    ::godot::ClassDB::bind_integer_constant(get_class_static(), ::godot::StringName(),             \
                                            #m_constant, m_constant)
#define BIND_ENUM_CONSTANT(m_constant)                                                             \
    ::godot::ClassDB::bind_integer_constant(                                                       \
        get_class_static(),                                                                        \
        ::godot::internal::enum_short_name(                                                        \
            ::godot::internal::EnumName<std::remove_cv_t<decltype(m_constant)>>::get()),           \
        #m_constant, static_cast<int64_t>(m_constant))

#define GDREGISTER_CLASS(m_class) ::godot::ClassDB::register_class<m_class>()
#define GDREGISTER_ABSTRACT_CLASS(m_class) ::godot::ClassDB::register_abstract_class<m_class>()
