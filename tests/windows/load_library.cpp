// Loads the add-on's DLL as an engine would, and calls its entry with an engine that offers nothing: it must answer
// "no", not crash. Then asks for HID devices: a system that has none, or no working HID library, must be told apart
// from a crash too. Built and run by the Windows tests alone.
#include <algorithm>
#include <cstdio>

#include <windows.h>

#include "device/hid/hid_bus.h"
#include "device/threads/real_time_thread.h"

namespace {

using Function = void (*)();
using GetFunction = Function (*)(const char *);
using Entry = unsigned char (*)(GetFunction, void *, void *);

Function nothing(const char * /*name*/) {
    return nullptr;
}

int failures = 0;

void check(bool good, const char *what) {
    std::printf("%s  %s\n", good ? "ok  " : "FAIL", what);
    failures += good ? 0 : 1;
}

} // namespace

int main(int argument_count, char **arguments) {
    int checks = 3;
    for (int i = 1; i < argument_count; ++i) {
        checks += 3;
        const HMODULE library = LoadLibraryA(arguments[i]);
        check(library != nullptr, arguments[i]);
        const FARPROC address =
            library != nullptr ? GetProcAddress(library, "spidar_g_library_init") : nullptr;
        check(address != nullptr, "the entry symbol");
        // Through a function pointer without arguments: compilers accept that detour for any function.
        const auto entry = reinterpret_cast<Entry>(reinterpret_cast<Function>(address));
        unsigned char initialization[64] = {};
        check(entry != nullptr && entry(&nothing, nullptr, initialization) == 0,
              "an engine without functions is refused");
    }
    check(argument_count > 1, "a library to load was given");
    std::vector<spidar::HidDeviceInfo> devices;
    const spidar::Status status = spidar::system_hid_bus()->enumerate(devices);
    std::printf("HID: %s (%u devices)\n", spidar::describe(status),
                static_cast<unsigned>(devices.size()));
    check(spidar::usable(status) || status == spidar::Status::hid_unavailable,
          "the HID library starts, or says that it does not");
    const bool granted = spidar::request_real_time();
    std::int64_t early_ns = 0;
    std::int64_t late_ns = 0;
    constexpr int kSleeps = 200;
    for (int i = 0; i < kSleeps; ++i) {
        const std::int64_t deadline_ns = spidar::monotonic_ns() + 1'000'000;
        spidar::sleep_until_ns(deadline_ns);
        const std::int64_t now_ns = spidar::monotonic_ns();
        early_ns = std::max(early_ns, deadline_ns - now_ns);
        late_ns += now_ns - deadline_ns;
    }
    std::printf("sleeps of 1 ms: %lld us late in the mean; real-time priority %s\n",
                static_cast<long long>(late_ns / kSleeps / 1000), granted ? "granted" : "refused");
    check(early_ns <= 0, "no sleep ends before its deadline");
    std::printf("%d passed, %d failed\n", checks - failures, failures);
    return failures == 0 ? 0 : 1;
}
