#pragma once

// Not part of the godot-cpp API: the engine classes that generate.py made, and the engine's singletons.

#include <godot_cpp/classes/wrapped.hpp>

#include <atomic>

namespace godot::internal {

// One engine class of classes.txt.
struct EngineClass {
    const char *name;
    Wrapped *(*wrap)(GodotObject *);
    std::atomic<void *> tag; // the engine's mark of the class, looked up when first needed
};

extern EngineClass engine_classes[]; // derived classes first
extern const std::size_t engine_class_count;

// A singleton of the engine: looked up when first asked for, and again when the library was unloaded and loaded.
class Singleton {
public:
    explicit Singleton(const char *name);

    // Null when this Godot has no T of that name.
    template <class T>
    T *get() {
        Wrapped *found = wrapped_.load(std::memory_order_acquire);
        if (found == nullptr) [[unlikely]] {
            found = look_up();
            if (dynamic_cast<T *>(found) == nullptr) {
                return nullptr;
            }
            wrapped_.store(found, std::memory_order_release);
        }
        return static_cast<T *>(found);
    }
    // The wrapper was ended.
    void forget() { wrapped_.store(nullptr, std::memory_order_release); }

private:
    Wrapped *look_up() const;

    const char *name_;
    std::atomic<Wrapped *> wrapped_ = nullptr;
};

// Ends the wrappers of all engine objects that live on when the library is unloaded: the engine would otherwise call the
// library to end them, when it is gone. Afterwards no wrapped object may be used.
void release_wrappers();

} // namespace godot::internal
