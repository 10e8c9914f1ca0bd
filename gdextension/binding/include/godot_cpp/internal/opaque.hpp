#pragma once

// Not part of the godot-cpp API: base of the built-in types whose bytes only the engine interprets.

#include <godot_cpp/internal/interface.hpp>
#include <godot_cpp/internal/plain_types.hpp>
#include <godot_cpp/internal/sizes.gen.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace godot::internal {

// A value of such a type. Its bytes may be moved in memory, as the engine itself does in its
// containers. The move constructor therefore copies the bytes and leaves an empty value behind.
template <GDExtensionVariantType kType, std::size_t kSize>
class Opaque {
public:
    GDExtensionTypePtr _native_ptr() const { return const_cast<std::byte *>(bytes_.data()); }

protected:
    Opaque() { lifecycle().construct(bytes_.data(), nullptr); }

    Opaque(const Opaque &other) { copy_from(other); }

    Opaque(Opaque &&other) noexcept : bytes_(other.bytes_) {
        lifecycle().construct(other.bytes_.data(), nullptr);
    }

    Opaque &operator=(const Opaque &other) {
        if (this != &other) {
            lifecycle().destroy(bytes_.data());
            copy_from(other);
        }
        return *this;
    }

    Opaque &operator=(Opaque &&other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }

    ~Opaque() { lifecycle().destroy(bytes_.data()); }

    bool equals(const Opaque &other) const {
        static const GDExtensionPtrOperatorEvaluator evaluate =
            api.variant_get_ptr_operator_evaluator(GDEXTENSION_VARIANT_OP_EQUAL, kType, kType);
        GDExtensionBool result = 0;
        evaluate(bytes_.data(), other.bytes_.data(), &result);
        return result != 0;
    }

    bool same_bytes(const Opaque &other) const { return bytes_ == other.bytes_; }

private:
    static const Lifecycle &lifecycle() { return lifecycles[kType]; }

    void copy_from(const Opaque &other) {
        const GDExtensionConstTypePtr source = other.bytes_.data();
        lifecycle().copy(bytes_.data(), &source);
    }

    alignas(8) std::array<std::byte, kSize> bytes_;
};

} // namespace godot::internal
