#pragma once

// Not part of the godot-cpp API: calls into the engine. If this Godot lacks a method, the first
// look-up prints the method's name, and calls return a default value.

#include <godot_cpp/internal/border.hpp>

#include <tuple>

namespace godot::internal {

struct EngineMethod {
    GDExtensionMethodBindPtr bind;
    EngineMethod(const char *class_name, const char *method, int64_t hash);
};

struct BuiltinMethod {
    GDExtensionPtrBuiltInMethod call;
    BuiltinMethod(GDExtensionVariantType type, const char *method, int64_t hash);
};

struct UtilityFunction {
    GDExtensionPtrUtilityFunction call;
    UtilityFunction(const char *name, int64_t hash);
};

// Prints that a method was called on an object that the engine does not know.
void report_no_owner();
// Prints why a call with a variable number of arguments failed.
void report_call_error(const GDExtensionCallError &error);

// Runs call(arguments, result address) with an array of the addresses of the arguments, and returns
// the result.
template <class R, class Call, class... Args>
R pointer_call(const Call &call, const Args &...args) {
    std::tuple<typename Border<Args>::Slot...> slots;
    return [&]<std::size_t... I>(std::index_sequence<I...>)->R {
        const void *arguments[] = {Border<Args>::lend(args, std::get<I>(slots))..., nullptr};
        if constexpr (std::is_void_v<R>) {
            call(arguments, nullptr);
        } else {
            typename Border<R>::Result result{};
            call(arguments, static_cast<void *>(&result));
            return Border<R>::take(result);
        }
    }
    (std::index_sequence_for<Args...>());
}

template <class R, class... Args>
R call_engine_static(const EngineMethod &method, const Args &...args) {
    if (method.bind == nullptr) [[unlikely]] {
        return R();
    }
    return pointer_call<R>(
        [&](const void *const *arguments, void *result) {
            api.object_method_bind_ptrcall(method.bind, nullptr, arguments, result);
        },
        args...);
}

template <class R, class... Args>
R call_engine(const EngineMethod &method, GodotObject *owner, const Args &...args) {
    if (method.bind == nullptr) [[unlikely]] {
        return R();
    }
    if (owner == nullptr) [[unlikely]] {
        report_no_owner();
        return R();
    }
    return pointer_call<R>(
        [&](const void *const *arguments, void *result) {
            api.object_method_bind_ptrcall(method.bind, owner, arguments, result);
        },
        args...);
}

template <class... Args>
Variant call_engine_vararg(const EngineMethod &method, GodotObject *owner, const Args &...args) {
    if (method.bind == nullptr) [[unlikely]] {
        return Variant();
    }
    if (owner == nullptr) [[unlikely]] {
        report_no_owner();
        return Variant();
    }
    const std::array<Variant, sizeof...(Args)> values{Variant(args)...};
    std::array<GDExtensionConstVariantPtr, sizeof...(Args)> addresses{};
    std::transform(values.begin(), values.end(), addresses.begin(),
                   [](const Variant &value) { return value._native_ptr(); });
    Variant result; // owns nothing while null, so that the engine may construct a value in place
    GDExtensionCallError error{GDEXTENSION_CALL_OK, 0, 0};
    api.object_method_bind_call(method.bind, owner, addresses.data(),
                                static_cast<GDExtensionInt>(addresses.size()), result._native_ptr(),
                                &error);
    if (error.error != GDEXTENSION_CALL_OK) [[unlikely]] {
        report_call_error(error);
    }
    return result;
}

template <class R, class... Args>
R call_builtin(const BuiltinMethod &method, GDExtensionTypePtr base, const Args &...args) {
    if (method.call == nullptr) [[unlikely]] {
        return R();
    }
    return pointer_call<R>(
        [&](const void *const *arguments, void *result) {
            method.call(base, arguments, result, static_cast<int32_t>(sizeof...(Args)));
        },
        args...);
}

template <class R, class... Args>
R call_utility(const UtilityFunction &function, const Args &...args) {
    if (function.call == nullptr) [[unlikely]] {
        return R();
    }
    return pointer_call<R>(
        [&](const void *const *arguments, void *result) {
            function.call(result, arguments, static_cast<int32_t>(sizeof...(Args)));
        },
        args...);
}

} // namespace godot::internal
