#pragma once

// Not part of the godot-cpp API: the types in the signature of a function, and calls of functions
// of this library by the engine.

#include <godot_cpp/internal/calls.hpp>
#include <godot_cpp/internal/class_record.hpp>

namespace godot::internal {

// Class, return type and argument types of a function. Plain: the type of a member function without
// noexcept.
template <class M>
struct Member;

#define GODOT_BINDING_MEMBER(m_const, m_noexcept)                                                  \
    template <class R, class C, class... A>                                                        \
    struct Member<R (C::*)(A...) m_const m_noexcept> {                                             \
        using Class = C;                                                                           \
        using Return = R;                                                                          \
        using Arguments = std::tuple<Decayed<A>...>;                                               \
        using Plain = R (C::*)(A...) m_const;                                                      \
        static constexpr uint32_t kFlags = std::is_const_v<m_const C>                              \
                                               ? GDEXTENSION_METHOD_FLAG_CONST                     \
                                               : GDEXTENSION_METHOD_FLAG_NORMAL;                   \
    }
GODOT_BINDING_MEMBER(, );
GODOT_BINDING_MEMBER(const, );
GODOT_BINDING_MEMBER(, noexcept);
GODOT_BINDING_MEMBER(const, noexcept);
#undef GODOT_BINDING_MEMBER

#define GODOT_BINDING_FUNCTION(m_noexcept)                                                         \
    template <class R, class... A>                                                                 \
    struct Member<R (*)(A...) m_noexcept> {                                                        \
        using Class = void;                                                                        \
        using Return = R;                                                                          \
        using Arguments = std::tuple<Decayed<A>...>;                                               \
        static constexpr uint32_t kFlags = GDEXTENSION_METHOD_FLAG_STATIC;                         \
    }
GODOT_BINDING_FUNCTION();
GODOT_BINDING_FUNCTION(noexcept);
#undef GODOT_BINDING_FUNCTION

// Calls function(arguments...) for a call by pointers: reads the arguments from their addresses and
// writes the result.
template <class R, class Arguments, class Function>
void answer_pointer_call(const Function &function, const GDExtensionConstTypePtr *arguments,
                         GDExtensionTypePtr result) {
    [&]<class... A, std::size_t... I>(std::tuple<A...> *, std::index_sequence<I...>) {
        if constexpr (std::is_void_v<R>) {
            function(Border<A>::decode(arguments[I])...);
        } else {
            Border<Decayed<R>>::give(result, function(Border<A>::decode(arguments[I])...));
        }
    }(static_cast<Arguments *>(nullptr), std::make_index_sequence<std::tuple_size_v<Arguments>>());
    static_cast<void>(arguments); // unused without arguments
    static_cast<void>(result);
}

// Calls function(arguments...) for a call by Variants. Requires as many arguments as the function
// takes.
template <class R, class Arguments, class Function>
Variant answer_variant_call(const Function &function, const Variant *const *arguments) {
    return [&]<class... A, std::size_t... I>(std::tuple<A...> *,
                                             std::index_sequence<I...>) -> Variant {
        static_cast<void>(arguments);
        if constexpr (std::is_void_v<R>) {
            function(Border<A>::from_variant(*arguments[I])...);
            return Variant();
        } else {
            return Border<Decayed<R>>::to_variant(
                function(Border<A>::from_variant(*arguments[I])...));
        }
    }(static_cast<Arguments *>(nullptr), std::make_index_sequence<std::tuple_size_v<Arguments>>());
}

// Adds the override of an engine class's virtual method, if T or an extension class above T has
// one.
template <class T, auto kMethod, auto kEngineMethod>
void add_virtual(std::vector<VirtualEntry> &entries, const char *name, uint32_t hash) {
    using Method = Member<decltype(kMethod)>;
    if constexpr (!std::is_same_v<typename Method::Class,
                                  typename Member<decltype(kEngineMethod)>::Class>) {
        entries.push_back(
            {StringName(name), hash,
             [](GDExtensionClassInstancePtr instance, const GDExtensionConstTypePtr *arguments,
                GDExtensionTypePtr result) {
                 T *self = static_cast<T *>(static_cast<Wrapped *>(instance));
                 answer_pointer_call<typename Method::Return, typename Method::Arguments>(
                     [self](const auto &...values) { return (self->*kMethod)(values...); },
                     arguments, result);
             }});
    }
}

} // namespace godot::internal
