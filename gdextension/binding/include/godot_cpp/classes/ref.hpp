#pragma once

#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/memory.hpp>

namespace godot {

// A reference that shares ownership of a RefCounted object.
template <typename T>
class Ref {
    template <typename>
    friend class Ref;
    friend struct internal::Border<Ref<T>>;

public:
    Ref() = default;
    Ref(T *object) { assign(object); }
    Ref(const Ref &other) { assign(other.object_); }
    Ref(Ref &&other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    template <typename U>
    Ref(const Ref<U> &other) {
        assign(Object::cast_to<T>(other.object_));
    }
    // Makes a null reference when the Variant holds no T.
    Ref(const Variant &value) { assign(Object::cast_to<T>(static_cast<Object *>(value))); }
    ~Ref() { unref(); }

    Ref &operator=(const Ref &other) {
        Ref(other).swap(*this);
        return *this;
    }
    Ref &operator=(Ref &&other) noexcept {
        Ref(std::move(other)).swap(*this);
        return *this;
    }

    bool operator==(const T *object) const { return object_ == object; }
    bool operator!=(const T *object) const { return object_ != object; }
    bool operator==(const Ref &other) const { return object_ == other.object_; }
    bool operator!=(const Ref &other) const { return object_ != other.object_; }
    T *operator->() const { return object_; }
    T *operator*() const { return object_; }
    T *ptr() const { return object_; }
    bool is_valid() const { return object_ != nullptr; }
    bool is_null() const { return object_ == nullptr; }
    operator Variant() const { return Variant(object_); }

    void unref() {
        if (object_ != nullptr && object_->unreference()) {
            memdelete(object_);
        }
        object_ = nullptr;
    }
    void instantiate() { Ref(memnew(T)).swap(*this); }

private:
    void assign(T *object) {
        if (object != nullptr && object->init_ref()) {
            object_ = object;
        }
    }
    void swap(Ref &other) noexcept { std::swap(object_, other.object_); }

    T *object_ = nullptr;
};

namespace internal {

template <class T>
struct Border<Ref<T>> {
    static constexpr Variant::Type type = Variant::OBJECT;
    static constexpr auto metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    using Slot = GodotObject *;
    using Result = GodotObject *;
    static const void *lend(const Ref<T> &value, Slot &slot) {
        slot = value.is_valid() ? value->_owner : nullptr;
        return &slot;
    }
    static Ref<T> decode(const void *address) {
        GodotObject *owner = address == nullptr ? nullptr : api.ref_get_object(address);
        return Ref<T>(Object::cast_to<T>(static_cast<Object *>(wrap(owner))));
    }
    // Takes over the reference that the engine returned and has already counted.
    static Ref<T> take(Result &result) {
        Ref<T> taken;
        auto *counted = Object::cast_to<RefCounted>(static_cast<Object *>(wrap(result)));
        taken.object_ = Object::cast_to<T>(counted);
        if (counted != nullptr && taken.object_ == nullptr && counted->unreference()) {
            memdelete(counted);
        }
        return taken;
    }
    static void give(void *address, const Ref<T> &value) {
        api.ref_set_object(address, value.is_valid() ? value->_owner : nullptr);
    }
    static Ref<T> from_variant(const Variant &value) { return Ref<T>(value); }
    static Variant to_variant(const Ref<T> &value) { return value; }
    static PropertyInfo info() {
        const StringName &name = T::get_class_static();
        return {type,         StringName(),           PROPERTY_HINT_RESOURCE_TYPE,
                String(name), PROPERTY_USAGE_DEFAULT, name};
    }
};

} // namespace internal
} // namespace godot
