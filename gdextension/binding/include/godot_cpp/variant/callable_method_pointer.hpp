#pragma once

#include <godot_cpp/internal/method_binder.hpp>

namespace godot {

namespace internal {

// Returns a Callable that calls record->call on `object` while that object lives. Two Callables are
// equal when their objects and their identities are equal. identity: identity_size bytes inside the
// record, which identify the method.
Callable make_callable(const Object *object, Wrapped *instance,
                       std::unique_ptr<MethodRecord> record, const void *identity,
                       std::size_t identity_size);

template <class T, class M>
Callable bound_callable(T *object, M method) {
    static_assert(std::is_same_v<std::remove_const_t<T>, typename Member<M>::Class>,
                  "callable_mp wants a method of the object's own class, not of a parent.");
    if (object == nullptr) {
        return Callable();
    }
    auto record = std::make_unique<BoundMethod<M>>(method);
    const void *identity = &record->method;
    return make_callable(object, object, std::move(record), identity, sizeof(M));
}

} // namespace internal

// Makes a Callable of a method of an extension class. The method need not be bound.
#define callable_mp(m_object, m_method) (::godot::internal::bound_callable(m_object, m_method))

} // namespace godot
