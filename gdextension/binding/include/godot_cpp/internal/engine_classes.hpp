#pragma once

// Not part of the godot-cpp API: the list of engine classes that generate.py writes, and the
// engine's singletons.

#include <godot_cpp/classes/wrapped.hpp>

#include <atomic>

namespace godot::internal {

// One engine class of classes.txt.
struct EngineClass {
    const char *name;
    Wrapped *(*wrap)(GodotObject *);
    std::atomic<void *> tag; // the engine's class tag, looked up when first needed
};

extern EngineClass engine_classes[]; // derived classes first
extern const std::size_t engine_class_count;

// A singleton of the engine. get() looks it up at the first call, and again after forget().
class Singleton {
public:
    explicit Singleton(const char *name);

    // Returns null when this Godot has no T of that name.
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
    // Called when the wrapper is destroyed.
    void forget() { wrapped_.store(nullptr, std::memory_order_release); }

private:
    Wrapped *look_up() const;

    const char *name_;
    std::atomic<Wrapped *> wrapped_ = nullptr;
};

// Called when the library is unloaded: destroys the wrappers of all engine objects. Otherwise the
// engine would call the unloaded library to destroy them. No wrapped object may be used afterwards.
void release_wrappers();

} // namespace godot::internal
