#pragma once

// Not part of the godot-cpp API: lets the engine call a bound method.

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/internal/own_arguments.hpp>

namespace godot::internal {

// Writes the arguments and missing defaults to `arranged`. Returns false and sets `error` when
// number or types of the arguments do not fit.
bool arrange_arguments(const MethodRecord &method, const GDExtensionConstVariantPtr *given,
                       GDExtensionInt count, const Variant **arranged, GDExtensionCallError &error);

// test() returns false for an object that is not of the argument's class.
template <class T>
struct ObjectFits {
    static bool test(const Variant &) { return true; }
};

template <ObjectPointer T>
struct ObjectFits<T> {
    static bool test(const Variant &value) {
        Object *object = static_cast<Object *>(value);
        return object == nullptr || dynamic_cast<T>(object) != nullptr;
    }
};

template <class T>
struct ObjectFits<Ref<T>> : ObjectFits<T *> {};

template <class T>
concept Carried = requires {
    Border<T>::type;
};

template <class Arguments>
inline constexpr bool kAllCarried = false;
template <class... A>
inline constexpr bool kAllCarried<std::tuple<A...>> = (Carried<A> && ...);

template <class M>
struct BoundMethod : MethodRecord {
    using Signature = Member<M>;
    using Class = typename Signature::Class;
    using Return = typename Signature::Return;
    using Arguments = typename Signature::Arguments;
    static constexpr std::size_t kCount = std::tuple_size_v<Arguments>;
    static constexpr bool kStatic = std::is_void_v<Class>;
    static_assert(
        kAllCarried<Arguments>,
        "A bound method has an argument of a type that the engine cannot give: use int64_t "
        "for long long.");
    static_assert(std::is_void_v<Return> || Carried<Decayed<Return>>,
                  "A bound method returns a type that the engine cannot take: use int64_t for long "
                  "long.");
    static_assert(!std::is_const_v<Return>,
                  "A bound method returns a const value: drop the const.");

    explicit BoundMethod(M bound) : method(bound) {
        flags = Signature::kFlags | GDEXTENSION_METHOD_FLAG_NORMAL;
        if constexpr (!std::is_void_v<Return>) {
            has_return = true;
            return_info = Border<Decayed<Return>>::info();
            return_metadata = Border<Decayed<Return>>::metadata;
        }
        [&]<class... A>(std::tuple<A...> *) {
            (arguments.push_back(Border<A>::info()), ...);
            (argument_metadata.push_back(Border<A>::metadata), ...);
            (insisted_types.push_back(insisted_type<A>()), ...);
        }(static_cast<Arguments *>(nullptr));
        call = &call_with_variants;
        pointer_call = &call_with_pointers;
    }

    // Returns a function that calls the method on `instance`.
    auto on(GDExtensionClassInstancePtr instance) const {
        if constexpr (kStatic) {
            static_cast<void>(instance);
            return [function = method](const auto &...values) { return function(values...); };
        } else {
            auto *self = static_cast<Class *>(static_cast<Wrapped *>(instance));
            return [self, function = method](const auto &...values) {
                return (self->*function)(values...);
            };
        }
    }

    static void call_with_pointers(void *userdata, GDExtensionClassInstancePtr instance,
                                   const GDExtensionConstTypePtr *given,
                                   GDExtensionTypePtr result) {
        const auto &bound = *static_cast<const BoundMethod *>(userdata);
        answer_pointer_call<Return, Arguments>(bound.on(instance), given, result);
    }

    static void call_with_variants(void *userdata, GDExtensionClassInstancePtr instance,
                                   const GDExtensionConstVariantPtr *given, GDExtensionInt count,
                                   GDExtensionVariantPtr result, GDExtensionCallError *error) {
        const auto &bound = *static_cast<const BoundMethod *>(userdata);
        std::array<const Variant *, kCount + 1> arranged{};
        if (!arrange_arguments(bound, given, count, arranged.data(), *error)) {
            return;
        }
        const int misfit = first_misfit(arranged.data(), static_cast<Arguments *>(nullptr),
                                        std::make_index_sequence<kCount>());
        if (misfit >= 0) {
            *error = {GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT, misfit, Variant::OBJECT};
            return;
        }
        const Variant answer =
            answer_variant_call<Return, Arguments>(bound.on(instance), arranged.data());
        api.variant_new_copy(result, answer._native_ptr());
    }

    template <class... A, std::size_t... I>
    static int first_misfit(const Variant *const *values, std::tuple<A...> *,
                            std::index_sequence<I...>) {
        int misfit = -1;
        static_cast<void>(values);
        static_cast<void>(
            ((ObjectFits<A>::test(*values[I]) || (misfit = static_cast<int>(I), false)) && ...));
        return misfit;
    }

    M method;
};

} // namespace godot::internal
