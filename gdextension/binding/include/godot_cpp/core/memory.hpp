#pragma once

#include <godot_cpp/core/object.hpp>
#include <godot_cpp/internal/hooks.hpp>

namespace godot::internal {

void send_postinitialize(Wrapped *object);
GodotObject *construct_engine_object(const StringName &class_name);
void destroy_object(Wrapped *object);

template <class T>
T *create() {
    static_assert(std::is_base_of_v<Object, T>, "memnew(T) is for engine objects only.");
    if constexpr (IsEngineClass<T>::value) {
        Wrapped *made = wrap(construct_engine_object(T::get_class_static()));
        send_postinitialize(made);
        return dynamic_cast<T *>(made);
    } else {
        const ClassRecord *record = find_class(T::get_class_static());
        return record == nullptr ? nullptr : dynamic_cast<T *>(create_object(*record, true));
    }
}

} // namespace godot::internal

// A new object of a registered class or of an engine class; null, with the reason printed, when
// the class is not registered. No constructor arguments.
#define memnew(m_class) (::godot::internal::create<m_class>())

// Ends an object that is not counted by a Ref and not in the scene tree.
#define memdelete(m_object) (::godot::internal::destroy_object(m_object))
