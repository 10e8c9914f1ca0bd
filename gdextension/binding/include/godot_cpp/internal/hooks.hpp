#pragma once

// Not part of the godot-cpp API: calls the hooks of an extension class (_notification, _set, _get,
// _validate_property, _to_string, _bind_methods) and of its parents.

#include <godot_cpp/classes/wrapped.hpp>

namespace godot::internal {

// Returns whether T itself declares the hook. Its signature must then be the expected one, since a
// hook with other types would never be called.
template <class T, class M, class Expected>
consteval bool declares() {
    if constexpr (std::is_same_v<typename Member<M>::Class, T>) {
        static_assert(std::is_same_v<typename Member<M>::Plain, Expected>,
                      "A hook (_notification, _set, _get, ...) has other types than the engine's.");
        return true;
    } else {
        return false;
    }
}

template <class T>
inline constexpr bool kIsTemplate = false;
template <template <class...> class Template, class... A>
inline constexpr bool kIsTemplate<Template<A...>> = true;
template <template <auto...> class Template, auto... A>
inline constexpr bool kIsTemplate<Template<A...>> = true;

template <class T>
struct Hooks {
    static_assert(!kIsTemplate<T>, "A template can be no class of the engine: it has no one name.");
    using Self = typename T::godot_binding_self;
    using Parent = typename T::godot_binding_parent;
    static_assert(std::is_same_v<Self, T>, "This class lacks its GDCLASS line.");
    static_assert(std::is_base_of_v<Parent, T>);
    static constexpr bool kParentIsOurs = !IsEngineClass<Parent>::value;

    static constexpr bool kNotification =
        declares<T, decltype(&T::_notification), void (T::*)(int)>();
    static constexpr bool kSet =
        declares<T, decltype(&T::_set), bool (T::*)(const StringName &, const Variant &)>();
    static constexpr bool kGet =
        declares<T, decltype(&T::_get), bool (T::*)(const StringName &, Variant &) const>();
    static constexpr bool kValidate =
        declares<T, decltype(&T::_validate_property), void (T::*)(PropertyInfo &) const>();
    static constexpr bool kToString =
        declares<T, decltype(&T::_to_string), String (T::*)() const>();

    static T *self(GDExtensionClassInstancePtr instance) {
        return static_cast<T *>(static_cast<Wrapped *>(instance));
    }

    static void notification(GDExtensionClassInstancePtr instance, int32_t what,
                             GDExtensionBool reversed) {
        if constexpr (kParentIsOurs) {
            if (reversed == 0) {
                Hooks<Parent>::notification(instance, what, reversed);
            }
        }
        if constexpr (kNotification) {
            self(instance)->T::_notification(what);
        }
        if constexpr (kParentIsOurs) {
            if (reversed != 0) {
                Hooks<Parent>::notification(instance, what, reversed);
            }
        }
    }

    static GDExtensionBool set(GDExtensionClassInstancePtr instance,
                               GDExtensionConstStringNamePtr name,
                               GDExtensionConstVariantPtr value) {
        if constexpr (kParentIsOurs) {
            if (Hooks<Parent>::set(instance, name, value) != 0) {
                return 1;
            }
        }
        if constexpr (kSet) {
            return self(instance)->T::_set(*static_cast<const StringName *>(name),
                                           *static_cast<const Variant *>(value))
                       ? 1
                       : 0;
        }
        return 0;
    }

    static GDExtensionBool get(GDExtensionClassInstancePtr instance,
                               GDExtensionConstStringNamePtr name, GDExtensionVariantPtr value) {
        if constexpr (kParentIsOurs) {
            if (Hooks<Parent>::get(instance, name, value) != 0) {
                return 1;
            }
        }
        if constexpr (kGet) {
            return self(instance)->T::_get(*static_cast<const StringName *>(name),
                                           *static_cast<Variant *>(value))
                       ? 1
                       : 0;
        }
        return 0;
    }

    static GDExtensionBool validate_property(GDExtensionClassInstancePtr instance,
                                             GDExtensionPropertyInfo *property) {
        if constexpr (kParentIsOurs) {
            Hooks<Parent>::validate_property(instance, property);
        }
        if constexpr (kValidate) {
            auto &name = *static_cast<StringName *>(property->name);
            auto &class_name = *static_cast<StringName *>(property->class_name);
            auto &hint_string = *static_cast<String *>(property->hint_string);
            PropertyInfo info(static_cast<Variant::Type>(property->type), name, PROPERTY_HINT_NONE,
                              hint_string, property->usage, class_name);
            info.hint = property->hint;
            self(instance)->T::_validate_property(info);
            property->type = static_cast<GDExtensionVariantType>(info.type);
            property->hint = info.hint;
            property->usage = info.usage;
            name = info.name;
            class_name = info.class_name;
            hint_string = info.hint_string;
        }
        return 1;
    }

    static void to_string(GDExtensionClassInstancePtr instance, GDExtensionBool *valid,
                          GDExtensionStringPtr text) {
        if constexpr (kToString) {
            *static_cast<String *>(text) = self(instance)->T::_to_string();
            *valid = 1;
        } else if constexpr (kParentIsOurs) {
            Hooks<Parent>::to_string(instance, valid, text);
        } else {
            *valid = 0;
        }
    }

    using BindMethods = void (*)();
    static constexpr BindMethods bind_methods() { return &T::_bind_methods; }
    static constexpr BindMethods parent_bind_methods() {
        if constexpr (kParentIsOurs) {
            return Hooks<Parent>::bind_methods();
        } else {
            return Access::no_bind_methods();
        }
    }

    // Sets the hooks that T or an extension class above T declares; the others stay null.
    static void fill(ClassRecord &record) {
        if constexpr (kParentIsOurs) {
            Hooks<Parent>::fill(record);
        }
        if (kNotification || record.notification != nullptr) {
            record.notification = &notification;
        }
        if (kSet || record.set != nullptr) {
            record.set = &set;
        }
        if (kGet || record.get != nullptr) {
            record.get = &get;
        }
        if (kValidate || record.validate_property != nullptr) {
            record.validate_property = &validate_property;
        }
        if (kToString || record.to_string != nullptr) {
            record.to_string = &to_string;
        }
        static_assert(bind_methods() != parent_bind_methods(),
                      "A registered class declares its own static void _bind_methods().");
        record.bind_methods = bind_methods();
    }
};

// Returns the nearest engine class among T and the parents of T.
template <class T>
consteval auto engine_base() {
    if constexpr (IsEngineClass<T>::value) {
        return std::type_identity<T>();
    } else {
        return engine_base<typename Hooks<T>::Parent>();
    }
}

template <class T>
using EngineBase = typename decltype(engine_base<T>())::type;

} // namespace godot::internal
