#pragma once

#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/internal/calls.hpp>
#include <godot_cpp/internal/class_record.hpp>
#include <godot_cpp/internal/members.hpp>

namespace godot {

namespace internal {

struct Access;
template <class T>
struct Hooks;
// The generated headers specialize these two for the engine's classes. Virtuals collects the
// virtual methods of a class.
template <class T>
struct IsEngineClass : std::false_type {};
template <class T>
struct Virtuals;
struct WrapOwner {
    GodotObject *owner;
};

// Returns the C++ object that stands for an engine object, and makes one when there is none yet.
// Returns null for null.
Wrapped *wrap(GodotObject *owner);

} // namespace internal

// Base of every class that stands for an engine object. memnew(T) or Ref<T>::instantiate() makes an
// object; the engine, memdelete() or the last Ref destroys it. No object may be on the stack.
class Wrapped {
    friend struct internal::Access;

public:
    Wrapped(const Wrapped &) = delete;
    Wrapped &operator=(const Wrapped &) = delete;

    GodotObject *_owner = nullptr;

protected:
    Wrapped();
    explicit Wrapped(internal::WrapOwner wrapped) : _owner(wrapped.owner) {}
    virtual ~Wrapped() = default;

    // Hooks that an extension class may declare. Hooks<T> (internal/hooks.hpp) calls them.
    static void _bind_methods() {}
    void _notification(int) {}
    bool _set(const StringName &, const Variant &) { return false; }
    bool _get(const StringName &, Variant &) const { return false; }
    void _validate_property(PropertyInfo &) const {}
    String _to_string() const { return {}; }
};

namespace internal {

struct Access {
    // Passes `owner` to Wrapped's constructor by expect(), so that T's constructor may call engine
    // methods.
    template <class T>
    static Wrapped *construct(const ClassRecord &record, GodotObject *owner) {
        expect(record, owner);
        return new T();
    }
    template <class T>
    static Wrapped *wrap(GodotObject *owner) {
        return new T(WrapOwner{owner});
    }
    static void destroy(Wrapped *object) { delete object; }
    static constexpr auto no_bind_methods() { return &Wrapped::_bind_methods; }
    static void expect(const ClassRecord &record, GodotObject *owner);
};

} // namespace internal

} // namespace godot

// First line of an engine class in the generated headers.
#define GODOT_BINDING_ENGINE_CLASS(m_class, m_inherits)                                            \
    friend struct ::godot::internal::Access;                                                       \
                                                                                                   \
protected:                                                                                         \
    m_class() = default;                                                                           \
    explicit m_class(::godot::internal::WrapOwner wrapped) : m_inherits(wrapped) {}                \
                                                                                                   \
public:                                                                                            \
    static const ::godot::StringName &get_class_static() {                                         \
        static const ::godot::StringName &name = ::godot::internal::persistent_name(#m_class);     \
        return name;                                                                               \
    }                                                                                              \
                                                                                                   \
private:

// First line of every extension class (a class that this library adds to the engine).
#define GDCLASS(m_class, m_inherits)                                                               \
private:                                                                                           \
    friend struct ::godot::internal::Access;                                                       \
    friend struct ::godot::internal::Hooks<m_class>;                                               \
    using godot_binding_self = m_class;                                                            \
    using godot_binding_parent = m_inherits;                                                       \
                                                                                                   \
public:                                                                                            \
    static const ::godot::StringName &get_class_static() {                                         \
        static const ::godot::StringName &name = ::godot::internal::persistent_name(#m_class);     \
        return name;                                                                               \
    }                                                                                              \
    static const ::godot::StringName &get_parent_class_static() {                                  \
        return m_inherits::get_class_static();                                                     \
    }                                                                                              \
                                                                                                   \
private:
