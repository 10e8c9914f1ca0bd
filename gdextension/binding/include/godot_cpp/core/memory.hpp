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

// Makes an object of an extension class or of an engine class. Returns null when the class is not
// registered. Takes no constructor arguments.
#define memnew(m_class) (::godot::internal::create<m_class>())

// Destroys an object. Requires that no Ref counts the object and that it is not in the scene tree.
#define memdelete(m_object) (::godot::internal::destroy_object(m_object))
