// Timers and priority on Windows. Compiled, and started under wine; not tested on Windows.
#include "device/threads/real_time_thread.h"

#if defined(_WIN32)

#include <chrono>
#include <cstddef>
#include <thread>

#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#include <windows.h>

#ifndef CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
#define CREATE_WAITABLE_TIMER_HIGH_RESOLUTION 0x00000002
#endif

namespace spidar {

namespace {

// Returns a function of a system library, or null: the add-on loads without either library.
template <typename Function>
Function system_function(const char *library, const char *name) noexcept {
    const HMODULE module = LoadLibraryA(library);
    return module != nullptr ? reinterpret_cast<Function>(
                                   reinterpret_cast<void (*)()>(GetProcAddress(module, name)))
                             : nullptr;
}

// Timer of one thread. High resolution is 0.5 ms (Windows 10, 1803 and later); an ordinary timer
// needs the system tick at 1 ms.
class WaitableTimer {
public:
    WaitableTimer() noexcept
        : handle_(CreateWaitableTimerExW(nullptr, nullptr, CREATE_WAITABLE_TIMER_HIGH_RESOLUTION,
                                         TIMER_ALL_ACCESS)) {
        if (handle_ != nullptr) {
            return;
        }
        using BeginPeriod = unsigned int(WINAPI *)(unsigned int);
        if (const auto begin = system_function<BeginPeriod>("winmm.dll", "timeBeginPeriod")) {
            constexpr unsigned int kTick_ms = 1;
            coarse_ = begin(kTick_ms) == 0;
        }
        handle_ = CreateWaitableTimerExW(nullptr, nullptr, 0, TIMER_ALL_ACCESS);
    }
    ~WaitableTimer() {
        if (handle_ != nullptr) {
            CloseHandle(handle_);
        }
        using EndPeriod = unsigned int(WINAPI *)(unsigned int);
        if (coarse_) {
            if (const auto end = system_function<EndPeriod>("winmm.dll", "timeEndPeriod")) {
                end(1);
            }
        }
    }
    WaitableTimer(const WaitableTimer &) = delete;
    WaitableTimer &operator=(const WaitableTimer &) = delete;

    // May return early.
    void wait(std::int64_t time_ns) noexcept {
        constexpr std::int64_t kUnit_ns = 100;
        LARGE_INTEGER due{};
        due.QuadPart = -((time_ns + kUnit_ns - 1) / kUnit_ns); // negative: from now
        if (handle_ == nullptr || !SetWaitableTimer(handle_, &due, 0, nullptr, nullptr, FALSE) ||
            WaitForSingleObject(handle_, INFINITE) != WAIT_OBJECT_0) {
            std::this_thread::sleep_for(std::chrono::nanoseconds(time_ns));
        }
    }

private:
    HANDLE handle_;
    bool coarse_ = false;
};

// The scheduler's class for audio, until the thread ends.
class MultimediaClass {
public:
    bool join() noexcept {
        using Set = HANDLE(WINAPI *)(LPCWSTR, LPDWORD);
        if (handle_ == nullptr) {
            if (const auto set =
                    system_function<Set>("avrt.dll", "AvSetMmThreadCharacteristicsW")) {
                DWORD task = 0;
                handle_ = set(L"Pro Audio", &task);
            }
        }
        return handle_ != nullptr;
    }
    MultimediaClass() noexcept = default;
    ~MultimediaClass() {
        using Revert = BOOL(WINAPI *)(HANDLE);
        if (handle_ != nullptr) {
            if (const auto revert =
                    system_function<Revert>("avrt.dll", "AvRevertMmThreadCharacteristics")) {
                revert(handle_);
            }
        }
    }
    MultimediaClass(const MultimediaClass &) = delete;
    MultimediaClass &operator=(const MultimediaClass &) = delete;

private:
    HANDLE handle_ = nullptr;
};

} // namespace

void sleep_until_ns(std::int64_t deadline_ns) noexcept {
    thread_local WaitableTimer timer;
    for (std::int64_t left_ns = deadline_ns - monotonic_ns(); left_ns > 0;
         left_ns = deadline_ns - monotonic_ns()) {
        timer.wait(left_ns);
    }
}

bool request_real_time() noexcept {
    thread_local MultimediaClass multimedia;
    const bool joined = multimedia.join();
    const bool raised =
        SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_TIME_CRITICAL) != FALSE;
    return joined || raised;
}

void name_thread(const char *name) noexcept {
    using Describe = HRESULT(WINAPI *)(HANDLE, PCWSTR);
    const auto set = system_function<Describe>("kernel32.dll", "SetThreadDescription");
    constexpr std::size_t kMost = 32;
    wchar_t wide[kMost] = {};
    for (std::size_t i = 0; i + 1 < kMost && name[i] != '\0'; ++i) {
        wide[i] = static_cast<unsigned char>(name[i]); // ASCII
    }
    if (set != nullptr) {
        set(GetCurrentThread(), wide);
    }
}

} // namespace spidar

#endif
