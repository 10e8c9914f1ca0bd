#pragma once

#include <godot_cpp/classes/object.hpp>

namespace godot::internal {

template <class T>
concept ObjectPointer =
    std::is_pointer_v<T> && std::is_base_of_v<Object, std::remove_cv_t<std::remove_pointer_t<T>>>;

template <ObjectPointer T>
struct Border<T> {
    using Class = std::remove_cv_t<std::remove_pointer_t<T>>;
    static constexpr Variant::Type type = Variant::OBJECT;
    static constexpr auto metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    using Slot = GodotObject *;
    using Result = GodotObject *;
    static const void *lend(const Object *value, Slot &slot) {
        slot = value == nullptr ? nullptr : value->_owner;
        return &slot;
    }
    static T decode(const void *address) {
        return dynamic_cast<T>(wrap(*static_cast<GodotObject *const *>(address)));
    }
    static T take(Result &result) { return dynamic_cast<T>(wrap(result)); }
    static void give(void *address, const Object *value) {
        *static_cast<GodotObject **>(address) = value == nullptr ? nullptr : value->_owner;
    }
    static T from_variant(const Variant &value) {
        return dynamic_cast<T>(static_cast<Object *>(value));
    }
    static Variant to_variant(const Object *value) { return Variant(value); }
    static PropertyInfo info() {
        const StringName &name = Class::get_class_static();
        return {type,         StringName(),           PROPERTY_HINT_RESOURCE_TYPE,
                String(name), PROPERTY_USAGE_DEFAULT, name};
    }
};

} // namespace godot::internal

namespace godot {

class ObjectDB {
public:
    // Returns null when the object was freed.
    static Object *get_instance(uint64_t p_object_id) {
        GodotObject *owner =
            p_object_id == 0 ? nullptr : internal::api.object_get_instance_from_id(p_object_id);
        return static_cast<Object *>(internal::wrap(owner));
    }
};

} // namespace godot
